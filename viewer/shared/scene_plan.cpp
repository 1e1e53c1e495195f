#include "shared/scene_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/fail.h"
#include "shared/auto_exposure.h"
#include "shared/scene_choice.h"
#include "stage/additions.h"
#include "stage/cutout/cutout.h"
#include "stage/default_light.h"
#include "stage/left_out.h"
#include "stage/looks.h"

namespace tenebra::viewer {
namespace {

constexpr Size default_size{800, 600};
constexpr double default_fov_deg = 45.0;
/// With --eye the near plane lies at this part of the way to the point looked at.
constexpr float near_of_distance = 1e-3f;

float radians(double degrees) {
  return static_cast<float>(degrees * std::numbers::pi / 180.0);
}

Size plan_size(const Scene& scene, int camera, const SceneOptions& options) {
  if (options.size) return *options.size;
  const auto aspect = scene.cameras[static_cast<std::size_t>(camera)].aspect;
  if (options.eye || !aspect || !(*aspect > 0)) return default_size;
  const double height = std::clamp<double>(default_size.width / *aspect, 1.0, largest_side_px);
  return {default_size.width, static_cast<int>(std::lround(height))};
}

Expected<void> apply_field_of_view(Scene& scene, int camera, const SceneOptions& options) {
  if (!options.fov_deg || options.eye) return {};
  Camera& chosen = scene.cameras[static_cast<std::size_t>(camera)];
  if (chosen.projection == Projection::orthographic) {
    return base::fail("--fov: camera {} ({}) is orthographic and has no field of view", camera, chosen.name);
  }
  chosen.vertical_fov_rad = radians(*options.fov_deg);
  for (Clip& clip : scene.clips)
    std::erase_if(clip.channels, [](const Channel& c) { return c.path == ChannelPath::camera_fov; });
  return {};
}

void complete(const SceneOptions& options, ScenePlan& plan) {
  // The camera is the same whatever --size is.
  plan.added =
      stage::add_missing_parts(plan.scene, {.floor = options.floor && !plan.environment, .aspect = {}});
  if (plan.added.light && !plan.added.lamp && !plan.environment) plan.environment = stage::soft_sky();
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

}  // namespace

Expected<ScenePlan> plan_scene(const SceneOptions& options) {
  auto scene = formats::import_scene(options.file, options.import);
  if (!scene) return tl::unexpected(scene.error());
  ScenePlan plan;
  plan.scene = std::move(*scene);
  std::string unmatched;
  if (!stage::leave_out_casters(plan.scene, options.no_cast, unmatched)) {
    return base::fail("--no-cast: {} names no mesh, material or FILE:LINE of the scene", unmatched);
  }
  if (options.transfer) plan.scene.transfer = *options.transfer;
  if (!options.environment.empty()) {
    auto picture = io::read_hdr(options.environment);
    if (!picture) return base::fail("--environment: {}", picture.error().message);
    plan.environment = std::move(*picture);
  }
  stage::leave_out_blank_emission(plan.scene);  // before a floor is added, which is not blank
  complete(options, plan);
  number_lights(plan.scene);
  stage::cut_out_masks(plan.scene, {.most_added = static_cast<std::size_t>(options.cutout_limit)});
  if (options.plain) stage::make_plain(plan.scene);
  if (!options.cast_all) stage::leave_out_covers(plan.scene);
  if (auto checked = stage::check_edits(options.edits, plan.scene); !checked)
    return tl::unexpected(checked.error());

  const auto clip = choose_clip(plan.scene, options.clip);
  if (!clip) return tl::unexpected(clip.error());
  plan.clip = *clip;
  const auto camera = choose_camera(plan.scene, options.camera);
  if (!camera) return tl::unexpected(camera.error());
  plan.camera = *camera;
  plan.size = plan_size(plan.scene, plan.camera, options);
  if (auto applied = apply_field_of_view(plan.scene, plan.camera, options); !applied) {
    return tl::unexpected(applied.error());
  }
  plan.display.transfer = plan.scene.transfer;
  if (options.meter_exposure) {
    const auto exposures = meter_exposures(plan, options);
    if (!exposures) return tl::unexpected(exposures.error());
    plan.display.exposures = *exposures;
  }
  return plan;
}

ViewRays view_of_camera(const ScenePlan& plan, int clip, int camera, double time_s, Size size) {
  ViewRays view = evaluate_camera(plan.scene, clip, time_s, camera, size.width, size.height);
  const bool added = plan.added.camera && camera + 1 == static_cast<int>(plan.scene.cameras.size());
  const float shape = added ? plan.scene.cameras.back().aspect.value_or(0.0f) : 0.0f;
  const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
  const float wider = shape * height / width;
  if (!(wider > 1)) return view;
  const glm::vec3 middle = view.d0 + 0.5f * width * view.dx + 0.5f * height * view.dy;
  view.dx *= wider;
  view.dy *= wider;
  view.d0 = middle - 0.5f * width * view.dx - 0.5f * height * view.dy;
  return view;
}

ViewRays view_of(const ScenePlan& plan, const SceneOptions& options, double time_s, Size size) {
  if (!options.eye) {
    return view_of_camera(plan, plan.clip, plan.camera, time_s, size);
  }
  const float near_m = near_of_distance * glm::distance(*options.eye, options.look_at);
  return look_at(*options.eye, options.look_at, options.up,
                 radians(options.fov_deg.value_or(default_fov_deg)), near_m, size.width, size.height);
}

Expected<int> check_light(const ScenePlan& plan, const stage::SceneEdits& edits, int light, double time_s) {
  const int count = static_cast<int>(stage::unmoved_lights(plan.scene, edits, plan.clip, time_s).size());
  if (light >= count) return base::fail("--light: found {}, the scene has lights 0 to {}", light, count - 1);
  return count;
}

}  // namespace tenebra::viewer
