#include "loaded_scene.h"

#include "base/fail.h"
#include "base/stopwatch.h"
#include "shared/auto_exposure.h"

namespace tenebra::python {

Expected<std::unique_ptr<LoadedScene>> LoadedScene::load(const std::string& path,
                                                         const std::string& arguments) {
  std::unique_ptr<LoadedScene> loaded(new LoadedScene);
  const auto command = viewer::lone_command();
  viewer::add_scene_options(*command, loaded->options_);
  if (auto parsed = viewer::parse_arguments(*command, arguments); !parsed)
    return tl::unexpected(parsed.error());
  loaded->options_.file = path;
  auto plan = viewer::plan_scene(loaded->options_);
  if (!plan) return tl::unexpected(plan.error());
  loaded->plan_ = std::move(*plan);
  viewer::ScenePlan& ready = loaded->plan_;
  ready.scene.lights = stage::lights_of(ready.scene, loaded->options_.edits);
  auto raster = render::FrameRaster::create({.kind = render::RasterKind::cpu});
  if (!raster) return tl::unexpected(raster.error());
  loaded->renderer_ = render::Renderer::create(std::move(*raster), ready.scene);
  if (ready.environment) loaded->renderer_->set_environment(*ready.environment);
  if (!loaded->options_.edits.materials.empty())
    loaded->renderer_->set_materials(stage::materials_of(ready.scene, loaded->options_.edits));
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
  if (auto good = viewer::check_scene_options(wish.scene); !good) return tl::unexpected(good.error());
  if (auto good = viewer::check_method_options(wish.method); !good) return tl::unexpected(good.error());
  if (auto good = viewer::check_aovs(wish.aovs, wish.method.render); !good)
    return tl::unexpected(good.error());
  return wish;
}

Expected<render::RenderSettings> LoadedScene::settings_of(const Wish& wish) {
  if (wish.method.auto_exposure && !plan_.display.exposures) {
    const auto exposures = viewer::meter_exposures(plan_, options_);
    if (!exposures) return tl::unexpected(exposures.error());
    plan_.display.exposures = *exposures;
  }
  render::RenderSettings settings =
      viewer::method_settings(wish.method, wish.scene.size.value_or(plan_.size), plan_.display);
  settings.area_lights.own_size_m = stage::edited_sizes_m(options_.edits.lights);
  settings.area_lights.own_sun_deg = stage::edited_suns_deg(options_.edits.lights);
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
  int camera = plan_.camera;
  if (wish.scene.camera) {
    const auto chosen = viewer::choose_camera(plan_.scene, wish.scene.camera);
    if (!chosen) return tl::unexpected(chosen.error());
    camera = *chosen;
  }
  const viewer::Size size{settings->width, settings->height};
  base::Stopwatch watch;
  render::FrameInput& input = input_;
  evaluate(*time_s, input.geometry);
  input.lights = lights(*time_s);
  input.view = wish.scene.eye ? viewer::view_of(plan_, wish.scene, *time_s, size)
                              : viewer::view_of_camera(plan_, plan_.clip, camera, *time_s, size);
  Picture picture;
  const auto note = [&work](std::string_view, double done) { work.done = done; };
  const double evaluate_ms = watch.lap_ms();
  if (auto drawn = renderer_->render_frame(input, *settings, picture.result, note, &work.stop); !drawn)
    return tl::unexpected(drawn.error());
  picture.result.timings.evaluate_ms = evaluate_ms;  // as the program's log has them
  picture.result.timings.total_ms = evaluate_ms + watch.lap_ms();
  const auto ids = renderer_->triangle_ids();
  picture.points.triangles.assign(ids.begin(), ids.end());
  if (wanted.points) {
    const TriangleView triangles = triangle_view(input.geometry);
    compute_visible_points(ids, size.width, size.height, input.view, triangles, picture.points);
    compute_shading_normals(picture.points, input.geometry.normals, input.view, triangles, picture.normals);
  }
  picture.view = input.view;
  picture.aovs = settings->aovs;
  return picture;
}

Expected<double> LoadedScene::time_of(int frame) const {
  if (frame < 0 || frame >= frames())
    return base::fail("frame {} does not exist, {} has frames 0 to {}", frame,
                      plan_.clip < 0 ? "the scene without animation" : "the animation", frames() - 1);
  return viewer::time_of_frame(plan_.scene, plan_.clip, frame, options_.fps);
}

void LoadedScene::evaluate(double time_s, FrameGeometry& geometry) const {
  evaluate_frame(plan_.scene, plan_.clip, time_s, geometry);
  stage::apply_node_edits(plan_.scene, options_.edits, geometry);
}

FrameGeometry LoadedScene::geometry(double time_s) const {
  FrameGeometry geometry;
  evaluate(time_s, geometry);
  return geometry;
}

}  // namespace tenebra::python
