#include "loaded_scene.h"

#include "base/fail.h"
#include "session/aovs.h"
#include "session/auto_exposure.h"

namespace tenebra::python {
namespace {

using settings::MethodSettings;
using settings::SceneSettings;
using settings::Setting;

constexpr std::string_view aov_name = "aov";

/// Whether a setting of the scene is chosen anew for each picture.
bool is_of_picture(const settings::About& about) {
  return about.group == settings::Group::camera || about.name == "size";
}
/// The moment is no keyword among these: render() has its own.
bool is_of_scene(const settings::About& about) {
  return !is_of_picture(about) && about.name != "time";
}

template <class Part, class Accept>
void add_names(std::span<const Setting<Part>> table, const Accept& accept, std::vector<std::string>& names) {
  for (const Setting<Part>& setting : table)
    if (accept(setting)) names.push_back(settings::underscored(setting.name));
}

/// Sets the row called so in Python, if the table has one that is accepted. False: it has none.
template <class Part, class Accept>
Expected<bool> set(std::span<const Setting<Part>> table, const std::pair<std::string, std::string>& keyword,
                   const Accept& accept, Part& part) {
  for (const Setting<Part>& setting : table) {
    if (settings::underscored(setting.name) != keyword.first || !accept(setting)) continue;
    if (auto read = setting.read(part, keyword.second); !read)
      return base::fail("{}: {}", keyword.first, read.error().message);
    return true;
  }
  return false;
}

const auto any = [](const settings::About&) { return true; };

}  // namespace

std::vector<std::string> names_of_scene() {
  std::vector<std::string> names;
  add_names(settings::scene_table(), is_of_scene, names);
  return names;
}

std::vector<std::string> names_of_render() {
  std::vector<std::string> names;
  add_names(settings::scene_table(), is_of_picture, names);
  add_names(settings::method_table(), any, names);
  names.emplace_back(aov_name);
  return names;
}

Expected<std::unique_ptr<LoadedScene>> LoadedScene::load(const std::string& path, const Keywords& keywords) {
  std::unique_ptr<LoadedScene> loaded(new LoadedScene);
  loaded->settings_.file = path;
  for (const auto& keyword : keywords) {
    const auto found = set(settings::scene_table(), keyword, is_of_scene, loaded->settings_);
    if (!found) return tl::unexpected(found.error());
  }
  auto session = session::Session::open(loaded->settings_, {.kind = render::RasterKind::cpu});
  if (!session) return tl::unexpected(session.error());
  loaded->session_.emplace(std::move(*session));
  loaded->display_ = loaded->staged().display;
  return loaded;
}

Expected<LoadedScene::Wish> LoadedScene::wish_of(const Keywords& keywords) const {
  Wish wish{keywords, settings_, {}, {}};
  settings::Given given;
  for (const auto& keyword : keywords) {
    if (keyword.first == aov_name) {
      const auto aovs = session::parse_aovs(keyword.second);
      if (!aovs) return base::fail("aov: {}", aovs.error().message);
      wish.aovs = *aovs;
      continue;
    }
    auto found = set(settings::scene_table(), keyword, is_of_picture, wish.scene);
    if (found && !*found) found = set(settings::method_table(), keyword, any, wish.method);
    if (!found) return tl::unexpected(found.error());
    given.insert(settings::dashed(keyword.first));
  }
  settings::settle_quality(given, wish.method);
  if (!wish.method.terminator) wish.method.terminator = render::Terminator::flat;  // as with any mask
  if (auto good = settings::check_scene_settings(wish.scene); !good) return tl::unexpected(good.error());
  if (auto good = settings::check_method_settings(wish.method); !good) return tl::unexpected(good.error());
  if (auto good = session::check_aovs(wish.aovs, wish.method.render); !good)
    return tl::unexpected(good.error());
  return wish;
}

Expected<render::RenderSettings> LoadedScene::settings_of(const Wish& wish) {
  if (wish.method.auto_exposure && !display_.exposures) {
    const auto exposures = session::meter_exposures(staged(), settings_);
    if (!exposures) return tl::unexpected(exposures.error());
    display_.exposures = *exposures;
  }
  render::RenderSettings settings =
      settings::render_settings(wish.method, wish.scene.size.value_or(staged().size), display_);
  settings.aovs = wish.aovs;
  return settings;
}

Expected<LoadedScene::Picture> LoadedScene::render(int frame, std::optional<double> time_s,
                                                   const Keywords& keywords, Wanted wanted, Work& work) {
  if (!wish_ || wish_->keywords != keywords) {
    auto wish = wish_of(keywords);
    if (!wish) return tl::unexpected(wish.error());
    wish_ = std::move(*wish);
  }
  const Wish& wish = *wish_;
  auto settings = settings_of(wish);
  if (!settings) return tl::unexpected(settings.error());
  settings->linear = wanted.linear;
  if (!time_s) {
    const auto time = time_of(frame);
    if (!time) return tl::unexpected(time.error());
    time_s = *time;
  }
  session::Viewpoint viewpoint = session::viewpoint_of(staged(), wish.scene);
  if (wish.scene.camera) {
    const auto chosen = session::choose_camera(staged().scene, wish.scene.camera);
    if (!chosen) return tl::unexpected(chosen.error());
    viewpoint.camera = *chosen;
  }
  const settings::Size size{settings->width, settings->height};
  session_->place(*time_s, session::rays_of(staged(), viewpoint, *time_s, size));
  Picture picture;
  const auto note = [&work](std::string_view, double done) { work.done = done; };
  if (auto drawn = session_->draw(*settings, picture.result, note, &work.stop); !drawn)
    return tl::unexpected(drawn.error());
  const render::FrameInput& input = session_->placed();
  const auto ids = session_->renderer().triangle_ids();
  picture.points.triangles.assign(ids.begin(), ids.end());
  if (wanted.points) {
    const TriangleView triangles = triangle_view(input.geometry);
    compute_visible_points(ids, size.width, size.height, input.view, triangles, picture.points);
    compute_shading_normals(picture.points, input.geometry.normals, triangles, picture.normals);
  }
  picture.view = input.view;
  picture.aovs = settings->aovs;
  return picture;
}

Expected<double> LoadedScene::time_of(int frame) const {
  const session::StagedScene& scene = staged();
  if (frame < 0 || frame >= scene.frames())
    return base::fail("frame {} does not exist, {} has frames 0 to {}", frame,
                      scene.clip < 0 ? "the scene without animation" : "the animation", scene.frames() - 1);
  return scene.time_of_frame(frame);
}

render::FrameInput LoadedScene::at(double time_s) const {
  render::FrameInput input;
  session::evaluate(staged().scene, settings_.edits, staged().clip, time_s, input);
  return input;
}

}  // namespace tenebra::python
