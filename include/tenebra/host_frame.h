// For programs with a renderer of their own: takes what it has drawn, from its OpenGL textures or its memory,
// as the ids and rays from which visible points are made (visible_points.h). Nothing here draws, and no
// OpenGL is linked. docs/foreign_renderer.md says what masks need to be exact.
#pragma once

#include <tenebra/expected.h>
#include <tenebra/visible_points.h>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

namespace tenebra {

/// How a host stores what it has drawn.
struct HostLayout {
  bool bottom_row_first = true;  ///< as OpenGL has it, y upwards; false: the top row
  /// The number that stands for triangle 0. Smaller numbers are background, and so are those past the last
  /// triangle. 1: for hosts that clear to 0 and write the id plus one.
  std::uint32_t first_id = 0;
};

/// What a host has drawn, row 0 at the top. Lists of width * height.
struct HostFrame {
  int width = 0;                   ///< pixels
  int height = 0;                  ///< pixels
  std::vector<std::uint32_t> ids;  ///< index into the triangles, or no_triangle
  std::vector<float> depth;        ///< 0 to 1, as the host's window has it; empty: not handed in
};

/// Takes ids, and depths unless `depth` is empty, from memory; `out` keeps its capacity. Fails with a
/// sentence if a list does not have width * height values.
Expected<void> take_host_frame(std::span<const std::uint32_t> ids, std::span<const float> depth, int width,
                               int height, const HostLayout& layout, HostFrame& out);

/// A host's camera by its matrices, in OpenGL's conventions: it looks along -Z of its own space, and visible
/// points have clip coordinates from -w to w in x and y, y upwards.
struct HostCamera {
  glm::dmat4 view_from_world{1.0};  ///< rigid; metres
  glm::dmat4 clip_from_view{1.0};   ///< perspective or orthographic, of any shape; reversed depth too
  bool depth_zero_to_one = false;   ///< clip z runs from 0 to w (glClipControl), not from -w
};

/// The rays through the centres of the camera's pixels, rounded to float; ViewRays::near_m is not set, as no
/// point depends on it. Fails with a sentence on sizes below 1 and matrices that span no picture.
Expected<ViewRays> host_view(const HostCamera& camera, int width, int height);

/// Points from depths alone, for comparison: their triangles are unknown, and their mask is not exact.
/// `positions`: width * height, metres, world space; NaN where the depth is `far_depth` (1, or 0 if
/// reversed). Fails with a sentence if the frame has no depths or the matrices cannot be inverted.
Expected<void> positions_from_depth(const HostFrame& frame, const HostCamera& camera, double far_depth,
                                    std::vector<glm::dvec3>& positions);

using GlFunction = void (*)();                              ///< of any type: cast before it is called
using GlFunctionLoader = GlFunction (*)(const char* name);  ///< glfwGetProcAddress and its like

/// OpenGL's names of a host's textures: two-dimensional, one sample per pixel, their first level as large as
/// the picture.
struct HostTextures {
  unsigned ids = 0;    ///< GL_R32UI
  unsigned depth = 0;  ///< a depth format or GL_R32F; 0: none
};

/// Reads textures in an OpenGL context that a host has made current, OpenGL 4.5 or newer. It calls only
/// functions that the loader finds; it has no global tables, makes no objects and leaves every setting and
/// binding as found. Use it where its context is current.
class HostContext {
public:
  /// The context that is current on this thread. Fails with a sentence if there is none or it is too old.
  static Expected<HostContext> adopt(GlFunctionLoader loader);
  HostContext(HostContext&&) noexcept;
  HostContext& operator=(HostContext&&) noexcept;
  ~HostContext();

  /// Waits until drawing into the textures has finished, and copies them; `out` keeps its capacity. The
  /// picture has the size of the texture of ids. Fails with a sentence on names that are not textures, and on
  /// wrong kinds, formats and sizes.
  Expected<void> read(const HostTextures& textures, const HostLayout& layout, HostFrame& out) const;

private:
  struct Functions;
  explicit HostContext(std::unique_ptr<Functions> functions);
  std::unique_ptr<Functions> functions_;
};

}  // namespace tenebra
