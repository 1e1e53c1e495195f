// One triangle of one view, made ready to find its samples' places and normals. Internal to shade.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/frame_geometry.h>
#include <tenebra/visible_points.h>

namespace tenebra::shade {

/// A value that is linear over the picture: `value` at the setup's origin, and its steps by pixels.
struct Plane {
  float value = 0, dx = 0, dy = 0;
};

/// What a sample's ray meets of the triangle, by window place (x, y) in pixels, row 0 at the top. The
/// coefficients are found in double and hold around `origin`, a place in the picture where the triangle is
/// seen.
struct TriangleSetup {
  std::uint32_t id = no_triangle;
  bool in_perspective = true;
  bool flat = true;      ///< no plane that the view could meet: all samples are its centroid
  bool smooth = false;   ///< the shading normal changes over it
  bool rounded = false;  ///< smooth, and the normals at its vertices are all on one side of it
  glm::vec2 origin{0.0f};
  Plane depth;        ///< perspective: proportional to 1 / depth, 1 at the origin
  Plane u, v;         ///< weights of the second and third vertex, in perspective times `depth`
  glm::vec3 a{0.0f};  ///< first vertex relative to the eye
  glm::vec3 e1{0.0f}, e2{0.0f};
  glm::vec3 face{0.0f};    ///< unit, to the eye's side; zero without an area
  glm::vec3 normal{0.0f};  ///< unit shading normal if not smooth; else unnormalised at the first vertex
  glm::vec3 to_second{0.0f}, to_third{0.0f};  ///< smooth: what the normal changes by
};

TriangleSetup set_up(const FrameGeometry& geometry, const ViewRays& view, std::uint32_t id,
                     const glm::vec2& origin);

/// The setups that neighbouring rows share. What it returns is valid until the next call.
class SetupCache {
public:
  const TriangleSetup& find(const FrameGeometry& geometry, const ViewRays& view, std::uint32_t id,
                            const glm::vec2& place);

private:
  static constexpr std::size_t size = 1024;
  std::array<std::uint16_t, size> slots_{};  // by the id's low bits: 1 + index into setups_; 0: none yet
  std::vector<TriangleSetup> setups_;
};

}  // namespace tenebra::shade
