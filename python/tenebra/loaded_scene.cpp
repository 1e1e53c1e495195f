#include "loaded_scene.h"

#include "base/fail.h"
#include "session/auto_exposure.h"

namespace tenebra::python {

Expected<std::unique_ptr<LoadedScene>> LoadedScene::load(const std::string& path,
                                                         const std::string& arguments) {
  std::unique_ptr<LoadedScene> loaded(new LoadedScene);
  const auto command = viewer::lone_command();
  viewer::add_scene_options(*command, loaded->options_);
  if (auto parsed = viewer::parse_arguments(*command, arguments); !parsed)
    return tl::unexpected(parsed.error());
  loaded->options_.file = path;
  auto session = session::Session::open(loaded->options_, {.kind = render::RasterKind::cpu});
  if (!session) return tl::unexpected(session.error());
  loaded->session_.emplace(std::move(*session));
  loaded->display_ = loaded->staged().display;
  return loaded;
}

Expected<LoadedScene::Wish> LoadedScene::wish_of(const std::string& arguments) const {
  Wish wish{arguments, options_, {}, {}};
  const auto command = viewer::lone_command();
  viewer::add_scene_options(*command, wish.scene);
  viewer::add_method_options(*command, wish.method);
  viewer::add_aov_option(*command, wish.aovs);
  if (auto parsed = viewer::parse_arguments(*command, arguments); !parsed)
    return tl::unexpected(parsed.error());
  viewer::settle_quality(*command, wish.method);
  if (!wish.method.terminator) wish.method.terminator = render::Terminator::flat;  // as with any mask
  if (auto good = viewer::check_scene_settings(wish.scene); !good) return tl::unexpected(good.error());
  if (auto good = viewer::check_method_settings(wish.method); !good) return tl::unexpected(good.error());
  if (auto good = viewer::check_aovs(wish.aovs, wish.method.render); !good)
    return tl::unexpected(good.error());
  return wish;
}

Expected<render::RenderSettings> LoadedScene::settings_of(const Wish& wish) {
  if (wish.method.auto_exposure && !display_.exposures) {
    const auto exposures = session::meter_exposures(staged(), options_);
    if (!exposures) return tl::unexpected(exposures.error());
    display_.exposures = *exposures;
  }
  render::RenderSettings settings =
      viewer::render_settings(wish.method, wish.scene.size.value_or(staged().size), display_);
  settings.aovs = wish.aovs;
  return settings;
}

Expected<LoadedScene::Picture> LoadedScene::render(int frame, std::optional<double> time_s,
                                                   const std::string& arguments, Wanted wanted, Work& work) {
  if (!wish_ || wish_->arguments != arguments) {
    auto wish = wish_of(arguments);
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
  session::evaluate(staged().scene, options_.edits, staged().clip, time_s, input);
  return input;
}

}  // namespace tenebra::python
