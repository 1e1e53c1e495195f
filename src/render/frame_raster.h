// Finds the triangle that each pixel sees: by OpenGL, or by the CPU where OpenGL is software or missing.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/frame_geometry.h>
#include <tenebra/frame_timings.h>
#include <tenebra/simd_level.h>
#include <tenebra/stop_flag.h>
#include "gl/context.h"
#include "visibility/visibility.h"

namespace tenebra::render {

class FrameShading;  // render/frame_shading.h

enum class RasterKind { automatic, gl, cpu };

/// How pictures are to be rasterised and their colours made, and the OpenGL context for it.
struct RasterChoice {
  RasterKind kind = RasterKind::automatic;
  RasterKind shading = RasterKind::automatic;  ///< who makes the colours; gl: what OpenGL can (GlShading);
                                               ///< automatic: the CPU
  gl::ContextChoice context;
  gl::ContextOptions options;
};

/// Finds what pixels see, in one of two ways, whose ids differ only where a pixel's centre lies on an edge,
/// up to OpenGL's rounding of vertices, and where depths are equal. Keeps its buffers.
class FrameRaster {
public:
  /// gl: by OpenGL. cpu: without any context. automatic: by OpenGL if there is a context and it draws by more
  /// than software. Fails with a sentence if there is no context, it lacks OpenGL 4.5 core or a shader does
  /// not build.
  static Expected<FrameRaster> create(const RasterChoice& choice);
  /// By OpenGL in this context, even if it is software. An adopted one is left as found after each draw
  /// (gl/kept_state.h).
  static Expected<FrameRaster> create(gl::Context context);
  FrameRaster(FrameRaster&&) noexcept;
  FrameRaster& operator=(FrameRaster&&) noexcept;
  ~FrameRaster();

  bool is_gl() const;
  /// Who makes the colours, as the choice had it; once, and to be destroyed before this object.
  std::unique_ptr<FrameShading> take_shading();
  bool shades_by_gl() const { return shades_by_gl_; }
  /// GL_RENDERER and GL_VERSION; "none" on the CPU.
  const std::string& gl_renderer() const;
  std::vector<std::string> take_debug_messages();

  Expected<void> check_picture_size(int width, int height) const;

  struct Wish {
    int width = 0;
    int height = 0;
    bool with_depth = false;
    SimdLevel simd = SimdLevel::automatic;
  };
  /// Fills raster_ms and readback_ms too.
  Expected<void> draw(const FrameGeometry& geometry, const ViewRays& view, const Wish& wish,
                      visibility::VisibleIds& out, FrameTimings& timings);
  /// What all pixels of `view` see at places from their centres, less than 0.5 each way
  /// (antialias/pattern.h).
  Expected<void> draw_places(const FrameGeometry& geometry, const ViewRays& view,
                             std::span<const glm::vec2> places, const Wish& wish, visibility::PlaceIds& out,
                             const StopFlag* stop);

private:
  struct Gl;
  FrameRaster();
  Expected<void> make_shading();
  std::unique_ptr<Gl> gl_;                   ///< null: on the CPU
  std::optional<gl::Context> for_shading_;   ///< where the CPU rasterises and OpenGL makes the colours
  std::unique_ptr<FrameShading> shading_{};  ///< null: taken, or by the CPU
  bool shades_by_gl_ = false;
  Expected<void> draw_one_by_one(const FrameGeometry& geometry, const ViewRays& view,
                                 std::span<const glm::vec2> places, const Wish& wish,
                                 visibility::PlaceIds& out, const StopFlag* stop);
  visibility::VisibilityPass cpu_;
  visibility::VisibleIds one_place_;
};

}  // namespace tenebra::render
