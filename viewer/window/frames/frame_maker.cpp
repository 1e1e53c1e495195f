#include "window/frames/frame_maker.h"

#include <cmath>

#include "window/frames/overlay_image.h"

namespace tenebra::viewer {
namespace {

session::Viewpoint viewpoint_of(const FrameRequest& request) {
  session::Viewpoint viewpoint{.clip = request.clip, .camera = request.camera, .placed = {}};
  if (const auto& free = request.free)
    viewpoint.placed = session::PlacedCamera{
        .eye = free->eye, .look_at = free->target, .up = free->up, .fov_deg = free->fov_deg};
  return viewpoint;
}

}  // namespace

ViewRays view_of_request(const FrameRequest& request, double time_s, Size size) {
  return session::rays_of(*request.scene, viewpoint_of(request), time_s, size);
}

Expected<void> FrameMaker::take_scene(const FrameRequest& request) {
  if (session_ && request.scene == scene_) {
    session_->edit(request.edits);
    return {};
  }
  // The old renderer goes while its context is current, before a new context takes its place.
  session_.reset();
  auto session = session::Session::open(request.scene, request.edits, raster_);
  if (!session) return tl::unexpected(session.error());
  session_.emplace(std::move(*session));
  scene_ = request.scene;
  return {};
}

void FrameMaker::forget() {
  session_.reset();
  scene_.reset();
}

Expected<Drawn> FrameMaker::draw(const FrameRequest& request, const render::RenderSettings& settings,
                                 double time_s, const AoProgress& progress, const StopFlag& stop) {
  Drawn drawn;
  if (auto done = session_->draw(settings, drawn.result, progress, &stop); !done)
    return tl::unexpected(done.error());
  const render::FrameResult& result = drawn.result;
  drawn.record = {.frame = request.clock.frame_of(time_s),
                  .time_s = time_s,
                  .timings = result.timings,
                  .stats = result.stats,
                  .soft = result.soft,
                  .ao = result.ao,
                  .antialias = result.antialias};
  return drawn;
}

void FrameMaker::keep_evidence(const FrameRequest& request, const render::RenderSettings& settings,
                               double time_s, Picture& picture) const {
  PictureEvidence& evidence = picture.evidence;
  const auto ids = session_->renderer().triangle_ids();
  evidence.ids.assign(ids.begin(), ids.end());
  evidence.lights = session_->renderer().drawn_lights();
  for (render::LightMask& mask : picture.a.result.masks) {
    if (mask.visible_fraction.pixels.empty()) continue;
    evidence.fractions.push_back({.light = mask.light, .visible_fraction = std::move(mask.visible_fraction)});
  }
  evidence.settings = session::with_edits(settings, request.edits);
  evidence.clip = request.clip;
  evidence.time_s = time_s;
  evidence.edits = request.edits;
}

Expected<std::shared_ptr<Picture>> FrameMaker::make(const FrameRequest& request, PreviewLevel level,
                                                    double time_s, const AoProgress& progress,
                                                    const StopFlag& stop) {
  if (auto taken = take_scene(request); !taken) return tl::unexpected(taken.error());
  const Size whole{request.a.width, request.a.height};
  render::RenderSettings settings = preview_settings(request.a, level);
  drawn_ = {settings.width, settings.height};
  ViewRays view = view_of_request(request, time_s, whole);
  if (level.divisor > 1) view = view_in_pixels(view, whole, drawn_);
  session_->place(request.clip, time_s, view);

  auto picture = std::make_shared<Picture>();
  settings.diagnostics = request.overlay != Overlay::none;
  auto a = draw(request, settings, time_s, progress, stop);
  if (!a) return tl::unexpected(a.error());
  picture->a = std::move(*a);
  keep_evidence(request, settings, time_s, *picture);
  if (request.b) {
    auto b = draw(request, preview_settings(*request.b, level), time_s, progress, stop);
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
  picture->view = view;
  picture->lights = stage::unmoved_lights(request.scene->scene, request.edits, request.clip, time_s);
  picture->clock = request.clock;
  return picture;
}

std::optional<glm::vec3> FrameMaker::visible_point(glm::dvec2 place) {
  if (!session_) return std::nullopt;
  const auto point = session_->renderer().visible_point(
      session_->placed(), static_cast<int>(std::floor(place.x * drawn_.width)),
      static_cast<int>(std::floor(place.y * drawn_.height)));
  return point ? std::optional<glm::vec3>(*point) : std::nullopt;
}

std::vector<std::string> FrameMaker::take_debug_messages() {
  return session_ ? session_->renderer().take_debug_messages() : std::vector<std::string>();
}

}  // namespace tenebra::viewer
