#include "session/staged_scene.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/fail.h"
#include "formats/format_list.h"
#include "session/brightness.h"
#include "session/environment_picture.h"
#include "session/viewpoint.h"
#include "stage/cutout/cutout.h"
#include "stage/default_light.h"
#include "stage/left_out.h"
#include "stage/looks.h"
#include "stage/tangents.h"

namespace tenebra::session {
namespace {

using settings::SceneSettings;
using settings::Size;

constexpr Size default_size{800, 600};

/// Names win over numbers, so that a clip called "2" can be reached.
template <class Named>
Expected<int> choose(const std::vector<Named>& list, const std::optional<std::string>& wanted,
                     std::string_view kind) {
  if (!wanted) return 0;
  std::string names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == *wanted) return static_cast<int>(i);
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", i, list[i].name);
  }
  const int index = settings::number_from<int>(*wanted).value_or(-1);
  if (index >= 0 && index < static_cast<int>(list.size())) return index;
  return base::fail("the scene has no {} called or numbered {}, it has {}", kind, *wanted,
                    names.empty() ? "none" : names);
}

Expected<int> choose_clip(const Scene& scene, const std::optional<std::string>& wanted) {
  if (scene.clips.empty() && !wanted) return -1;
  return choose(scene.clips, wanted, "--clip");
}

Size picture_size(const Scene& scene, int camera, const SceneSettings& settings) {
  if (settings.size) return *settings.size;
  if (settings.eye || scene.cameras.empty()) return default_size;
  const auto aspect = scene.cameras[static_cast<std::size_t>(camera)].aspect;
  if (!aspect || !(*aspect > 0)) return default_size;
  const double height = std::clamp<double>(default_size.width / *aspect, 1.0, settings::largest_side_px);
  return {default_size.width, static_cast<int>(std::lround(height))};
}

Expected<void> apply_field_of_view(Scene& scene, int camera, const SceneSettings& settings) {
  if (!settings.fov_deg || settings.eye || scene.cameras.empty()) return {};
  Camera& chosen = scene.cameras[static_cast<std::size_t>(camera)];
  if (chosen.projection == Projection::orthographic) {
    return base::fail("--fov: camera {} ({}) is orthographic and has no field of view", camera, chosen.name);
  }
  chosen.vertical_fov_rad = radians(*settings.fov_deg);
  for (Clip& clip : scene.clips)
    std::erase_if(clip.channels, [](const Channel& c) { return c.path == ChannelPath::camera_fov; });
  return {};
}

/// Nodes may share a light: each gets its own, so that a light has the same number for --light, for
/// --set-light and in the viewer's list.
void number_lights(Scene& scene) {
  std::vector<Light> lights;
  for (Node& node : scene.nodes) {
    if (node.light < 0) continue;
    lights.push_back(scene.lights[static_cast<std::size_t>(node.light)]);
    node.light = static_cast<int>(lights.size()) - 1;
  }
  scene.lights = std::move(lights);
}

/// The scene as the file and the settings have it, its surroundings beside it.
Expected<StagedScene> read(const SceneSettings& settings) {
  StagedScene staged;
  formats::ImportOptions import = settings.import;
  import.files_read = &staged.inputs;
  auto scene = formats::import_scene(settings.file, import);
  if (!scene) return tl::unexpected(scene.error());
  staged.scene = std::move(*scene);
  std::string unmatched;
  if (!stage::leave_out_casters(staged.scene, settings.no_cast, unmatched)) {
    return base::fail("--no-cast: {} names no mesh, material or FILE:LINE of the scene", unmatched);
  }
  staged.fps = settings.fps;
  if (settings.environment.empty()) return staged;
  auto picture = read_environment(settings.environment);
  if (!picture) return base::fail("--environment: {}", picture.error().message);
  staged.environment = std::move(*picture);
  staged.inputs.emplace_back(settings.environment);
  return staged;
}

bool assumes_up(const SceneSettings& settings) {
  const formats::FileFormat* const format = formats::format_of(settings.file);
  return !settings.import.placement.up && format != nullptr && !format->states_coordinates;
}

void add_missing_parts(const SceneSettings& settings, Staging staging, StagedScene& staged) {
  // The camera is the same whatever --size is.
  const stage::Additions wish{.floor = settings.floor && !staged.environment,
                              .aspect = {},
                              .sky = wanted_sun(settings, staged.scene, staged.environment.has_value()),
                              .up_assumed = assumes_up(settings),
                              .shines = !settings.emissive_lights && any_mesh_shines(staged.scene),
                              .for_pictures = staging == Staging::for_pictures};
  staged.added = stage::add_missing_parts(staged.scene, wish);
  const bool in_the_open = staged.added.light && !staged.added.lamp;
  if (in_the_open && !staged.environment) staged.environment = stage::soft_sky();
}

/// Clip, camera and size of pictures.
Expected<void> choose_view(const SceneSettings& settings, StagedScene& staged) {
  const auto clip = choose_clip(staged.scene, settings.clip);
  if (!clip) return tl::unexpected(clip.error());
  staged.clip = *clip;
  const auto camera = choose_camera(staged.scene, settings.camera);
  if (!camera) return tl::unexpected(camera.error());
  staged.camera = *camera;
  staged.size = picture_size(staged.scene, staged.camera, settings);
  return apply_field_of_view(staged.scene, staged.camera, settings);
}

}  // namespace

int StagedScene::frames() const {
  return clip < 0 ? 1 : frame_count(scene.clips[static_cast<std::size_t>(clip)], fps);
}

double StagedScene::time_of_frame(int frame) const {
  return clip < 0 ? 0.0 : frame_time_s(scene.clips[static_cast<std::size_t>(clip)], frame, fps);
}

Expected<int> choose_camera(const Scene& scene, const std::optional<std::string>& wanted) {
  return choose(scene.cameras, wanted, "--camera");
}

Expected<StagedScene> stage_scene(const SceneSettings& settings, Staging staging) {
  auto staged = read(settings);
  if (!staged) return staged;
  Scene& scene = staged->scene;
  stage::leave_out_blank_emission(scene);  // before a floor is added, which is not blank
  const bool stated = states_surroundings(scene);
  staged->light_has_units = !stated && has_units(scene);
  add_missing_parts(settings, staging, *staged);
  number_lights(scene);
  stage::cut_out_masks(scene, {.most_added = static_cast<std::size_t>(settings.cutout_limit)});
  if (settings.plain) stage::make_plain(scene);
  stage::add_tangents(scene);
  if (!settings.cast_all) stage::leave_out_covers(scene);
  if (auto checked = stage::check_edits(settings.edits, scene); !checked)
    return tl::unexpected(checked.error());
  if (auto chosen = choose_view(settings, *staged); !chosen) return tl::unexpected(chosen.error());
  if (settings.transfer) scene.transfer = *settings.transfer;  // until here it says what the file is
  staged->display.frame = scene.frame;
  staged->display.transfer = scene.transfer;
  if (auto settled = settle_brightness(settings, stated, *staged); !settled)
    return tl::unexpected(settled.error());
  return staged;
}

}  // namespace tenebra::session
