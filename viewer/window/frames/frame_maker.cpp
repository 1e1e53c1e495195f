#include "window/frames/frame_maker.h"

#include <cmath>

#include "base/stopwatch.h"
#include "window/frames/overlay_image.h"

namespace tenebra::viewer {
namespace {

/// The free camera as the options of `tenebra render` give it.
SceneOptions options_of(const FreeCamera& camera) {
  SceneOptions options;
  options.eye = camera.eye;
  options.look_at = camera.target;
  options.up = camera.up;
  options.fov_deg = camera.fov_deg;
  return options;
}

}  // namespace

ViewRays view_of_request(const FrameRequest& request, double time_s, Size size) {
  if (request.free) return view_of(*request.scene, options_of(*request.free), time_s, size);
  return view_of_camera(*request.scene, request.clip, request.camera, time_s, size);
}

Expected<void> FrameMaker::take_scene(const std::shared_ptr<const ScenePlan>& scene) {
  if (renderer_ && scene == scene_) return {};
  // The old renderer goes while its context is current, before a new context takes its place.
  renderer_.reset();
  auto raster = render::FrameRaster::create(raster_);
  if (!raster) return tl::unexpected(raster.error());
  renderer_.emplace(render::Renderer::create(std::move(*raster), scene->scene));
  if (scene->environment) renderer_->set_environment(*scene->environment);
  scene_ = scene;
  materials_.clear();
  return {};
}

void FrameMaker::forget() {
  renderer_.reset();
  scene_.reset();
  input_ = {};
}

Expected<Drawn> FrameMaker::draw(const FrameRequest& request, const render::RenderSettings& settings,
                                 double time_s, const AoProgress& progress, const StopFlag& stop) {
  Drawn drawn;
  base::Stopwatch watch;
  if (auto done = renderer_->render_frame(input_, settings, drawn.result, progress, &stop); !done) {
    return tl::unexpected(done.error());
  }
  const render::FrameResult& result = drawn.result;
  drawn.record = {.frame = request.clock.frame_of(time_s),
                  .time_s = time_s,
                  .timings = result.timings,
                  .stats = result.stats,
                  .soft = result.soft,
                  .ao = result.ao,
                  .antialias = result.antialias};
  drawn.record.timings.evaluate_ms = evaluate_ms_;
  drawn.record.timings.total_ms = watch.lap_ms() + evaluate_ms_;
  return drawn;
}

void FrameMaker::keep_evidence(const FrameRequest& request, const render::RenderSettings& settings,
                               double time_s, Picture& picture) const {
  PictureEvidence& evidence = picture.evidence;
  const auto ids = renderer_->triangle_ids();
  evidence.ids.assign(ids.begin(), ids.end());
  evidence.lights = renderer_->drawn_lights();
  for (render::LightMask& mask : picture.a.result.masks) {
    if (mask.visible_fraction.pixels.empty()) continue;
    evidence.fractions.push_back({.light = mask.light, .visible_fraction = std::move(mask.visible_fraction)});
  }
  evidence.settings = settings;
  evidence.clip = request.clip;
  evidence.time_s = time_s;
  evidence.edits = request.edits;
}

Expected<std::shared_ptr<Picture>> FrameMaker::make(const FrameRequest& request, PreviewLevel level,
                                                    double time_s, const AoProgress& progress,
                                                    const StopFlag& stop) {
  if (auto taken = take_scene(request.scene); !taken) return tl::unexpected(taken.error());
  const Scene& scene = request.scene->scene;
  base::Stopwatch watch;
  evaluate_frame(scene, request.clip, time_s, input_.geometry);
  stage::apply_node_edits(scene, request.edits, input_.geometry);
  input_.lights = stage::placed_lights(scene, request.edits, request.clip, time_s);
  const Size whole{request.a.width, request.a.height};
  render::RenderSettings settings = preview_settings(request.a, level);
  drawn_ = {settings.width, settings.height};
  input_.view = view_of_request(request, time_s, whole);
  if (level.divisor > 1) input_.view = view_in_pixels(input_.view, whole, drawn_);
  evaluate_ms_ = watch.lap_ms();
  renderer_->set_lights(stage::lights_of(scene, request.edits));
  if (request.edits.materials != materials_) {
    renderer_->set_materials(stage::materials_of(scene, request.edits));
    materials_ = request.edits.materials;
  }

  auto picture = std::make_shared<Picture>();
  settings.area_lights.own_size_m = stage::edited_sizes_m(request.edits.lights);
  settings.area_lights.own_sun_deg = stage::edited_suns_deg(request.edits.lights);
  settings.diagnostics = request.overlay != Overlay::none;
  auto a = draw(request, settings, time_s, progress, stop);
  if (!a) return tl::unexpected(a.error());
  picture->a = std::move(*a);
  keep_evidence(request, settings, time_s, *picture);
  if (request.b) {
    render::RenderSettings settings_b = preview_settings(*request.b, level);
    settings_b.area_lights.own_size_m = settings.area_lights.own_size_m;
    settings_b.area_lights.own_sun_deg = settings.area_lights.own_sun_deg;
    auto b = draw(request, settings_b, time_s, progress, stop);
    if (!b) return tl::unexpected(b.error());
    picture->difference = compare_pictures(picture->a.result.image, b->result.image, 0);
    picture->b = std::move(*b);
  }
  picture->overlay = make_overlay(request.overlay, picture->a.result);
  picture->a.result.masks
      .clear();  // the window shows the picture, not the masks: the evidence has what it needs
  if (picture->b) picture->b->result.masks.clear();
  picture->scene = request.scene;
  picture->slot = request.slot;
  picture->preview = preview_text(request.a, level);
  picture->whole = whole;
  picture->view = input_.view;
  picture->lights = stage::unmoved_lights(scene, request.edits, request.clip, time_s);
  picture->clock = request.clock;
  return picture;
}

std::optional<glm::vec3> FrameMaker::visible_point(glm::dvec2 place) {
  if (!renderer_) return std::nullopt;
  const auto point = renderer_->visible_point(input_, static_cast<int>(std::floor(place.x * drawn_.width)),
                                              static_cast<int>(std::floor(place.y * drawn_.height)));
  return point ? std::optional<glm::vec3>(*point) : std::nullopt;
}

std::vector<std::string> FrameMaker::take_debug_messages() {
  return renderer_ ? renderer_->take_debug_messages() : std::vector<std::string>();
}

}  // namespace tenebra::viewer
