#include "render/frame_raster.h"

#include <algorithm>
#include <optional>
#include <span>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "gl/kept_state.h"
#include "gl/renderer_name.h"
#include "parallel/parallel.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"
#include "render/antialias/pattern.h"
#include "render/gl_shading.h"

namespace tenebra::render {

struct FrameRaster::Gl {
  gl::Context context;  // first, so that it is destroyed last
  raster::GBufferPass pass;
  raster::GeometryBuffers geometry;
  raster::GBuffer gbuffer{};
  gl::Readback ids{}, depth{}, layer{};

  Expected<void> read(visibility::VisibleIds& out, bool with_depth);
};

namespace {

template <class T>
Expected<void> finish(gl::Readback& readback, std::size_t pixels, std::vector<T>& out) {
  out.resize(pixels);
  return readback.finish(std::as_writable_bytes(std::span(out)));
}

}  // namespace

/// All copies are under way before the first is waited for.
Expected<void> FrameRaster::Gl::read(visibility::VisibleIds& out, bool with_depth) {
  const std::size_t pixels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  if (auto begun = ids.start(gbuffer.ids); !begun) return begun;
  if (with_depth) {
    if (auto begun = depth.start(gbuffer.depth); !begun) return begun;
  }
  if (out.has_layer) {
    if (auto begun = layer.start(gbuffer.layer_ids); !begun) return begun;
  }
  out.depth.clear();
  out.layer.clear();
  if (auto got = finish(ids, pixels, out.ids); !got) return got;
  if (with_depth) {
    if (auto got = finish(depth, pixels, out.depth); !got) return got;
  }
  return out.has_layer ? finish(layer, pixels, out.layer) : Expected<void>();
}

FrameRaster::FrameRaster() = default;
FrameRaster::FrameRaster(FrameRaster&&) noexcept = default;
FrameRaster& FrameRaster::operator=(FrameRaster&&) noexcept = default;
FrameRaster::~FrameRaster() = default;

Expected<FrameRaster> FrameRaster::create(gl::Context context) {
  auto pass = raster::GBufferPass::create();
  if (!pass) return tl::unexpected(pass.error());
  FrameRaster result;
  result.gl_ =
      std::make_unique<Gl>(Gl{.context = std::move(context), .pass = std::move(*pass), .geometry = {}});
  return result;
}

Expected<FrameRaster> FrameRaster::create(const RasterChoice& choice) {
  // The passes that make colours have been held to the CPU's on software OpenGL, and never ran on a GPU.
  const bool shades = choice.shading == RasterKind::gl;
  if (choice.kind == RasterKind::cpu && !shades) return FrameRaster();
  auto context = gl::Context::create(choice.context, choice.options);
  const bool hardware = context && !gl::is_software_renderer(context->description());
  const bool draws = choice.kind == RasterKind::gl || (choice.kind == RasterKind::automatic && hardware);
  if (!draws && !shades) return FrameRaster();
  if (!context) return tl::unexpected(context.error());
  FrameRaster result;
  if (draws) {
    auto made = create(std::move(*context));
    if (!made) return made;
    result = std::move(*made);
  } else {
    result.for_shading_.emplace(std::move(*context));
  }
  if (!shades) return result;
  if (auto made = result.make_shading(); !made) return tl::unexpected(made.error());
  return result;
}

Expected<void> FrameRaster::make_shading() {
  auto made = GlShading::create();
  if (!made) return tl::unexpected(std::move(made.error()));
  shading_ = std::move(*made);
  shades_by_gl_ = true;
  return {};
}

std::unique_ptr<FrameShading> FrameRaster::take_shading() {
  if (shading_) return std::move(shading_);
  return std::make_unique<CpuShading>();
}

bool FrameRaster::is_gl() const {
  return gl_ != nullptr;
}

const std::string& FrameRaster::gl_renderer() const {
  static const std::string none = "none";
  return gl_ ? gl_->context.description() : for_shading_ ? for_shading_->description() : none;
}

std::vector<std::string> FrameRaster::take_debug_messages() {
  return gl_ ? gl_->context.take_debug_messages() : std::vector<std::string>();
}

Expected<void> FrameRaster::check_picture_size(int width, int height) const {
  return gl_ ? raster::check_picture_size(width, height) : visibility::check_picture_size(width, height);
}

Expected<void> FrameRaster::draw(const FrameGeometry& geometry, const ViewRays& view, const Wish& wish,
                                 visibility::VisibleIds& out, FrameTimings& timings) {
  base::Stopwatch watch;
  if (!gl_) {
    Expected<void> drawn;
    drawn = cpu_.draw(geometry, view, wish.width, wish.height, wish.with_depth, wish.simd, out);
    timings.raster_ms = watch.lap_ms();
    return drawn;
  }
  Gl& gl = *gl_;
  std::optional<gl::KeptState> kept;
  if (gl.context.is_adopted()) kept.emplace();
  if (auto uploaded = gl.geometry.upload(geometry); !uploaded) return uploaded;
  if (auto drawn = gl.pass.draw(view, gl.geometry, wish.width, wish.height, gl.gbuffer); !drawn) return drawn;
  timings.raster_ms = watch.lap_ms();
  out.width = wish.width, out.height = wish.height;
  out.transform = gl.gbuffer.transform;
  out.has_layer = gl.gbuffer.has_layer;
  auto got = gl.read(out, wish.with_depth);
  timings.readback_ms = watch.lap_ms();
  return got;
}

Expected<void> FrameRaster::draw_one_by_one(const FrameGeometry& geometry, const ViewRays& view,
                                            std::span<const glm::vec2> places, const Wish& wish,
                                            visibility::PlaceIds& out, const StopFlag* stop) {
  out.begin(wish.width, wish.height, places.size(), visibility::has_see_through(geometry));
  out.open_all();
  FrameTimings unused;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (stop_requested(stop)) return base::stopped();
    if (auto drawn = draw(geometry, shifted_view(view, places[k]), wish, one_place_, unused); !drawn)
      return drawn;
    out.set_place(k, one_place_.ids, one_place_.layer);
  }
  return {};
}

Expected<void> FrameRaster::draw_places(const FrameGeometry& geometry, const ViewRays& view,
                                        std::span<const glm::vec2> places, const Wish& wish,
                                        visibility::PlaceIds& out, const StopFlag* stop) {
  if (gl_) return draw_one_by_one(geometry, view, places, wish, out, stop);
  Expected<bool> at_once = true;
  at_once = cpu_.draw_places(geometry, view, wish.width, wish.height, places, wish.simd, out);
  if (!at_once) return tl::unexpected(at_once.error());
  return *at_once ? Expected<void>() : draw_one_by_one(geometry, view, places, wish, out, stop);
}

}  // namespace tenebra::render
