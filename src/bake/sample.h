// Where the light of a texel or a vertex is found: a place on a triangle, never on its edges.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "math/vertex_rounding.h"

namespace tenebra::bake {

struct Sample {
  std::uint32_t target = 0;    ///< the texel or the vertex that it counts for
  std::uint32_t triangle = 0;  ///< id in FrameGeometry
  float share = 1;             ///< of the target's mean, relative to its other samples
  glm::dvec3 weights{0.0};     ///< of the triangle's corners; they sum to 1
};

using Triangle = std::array<glm::dvec3, 3>;

/// The weights of the place nearest to `weights` on the way to the middle of the triangle's inscribed circle
/// that keeps `margin_m` from all three edges; half the circle's radius where the triangle is too small for
/// that. None: the triangle has no area.
///
/// The contact rule leaves a point lit that lies on a wall's plane, as a point on the edge between floor and
/// wall does. So a sample that is clamped onto an edge would be lit from outside a closed room.
std::optional<glm::dvec3> weights_inside(const Triangle& corners, const glm::dvec3& weights, double margin_m);

/// 64 times what rounding to float moves a vertex by, in a scene whose largest |coordinate| is `extent_m`:
/// 0.7 mm in 100 m. By the contact rule 2 times would do where walls stand upright on a floor; the rest is
/// for walls that lean over it down to 2 degrees.
inline double edge_margin(double extent_m) {
  return 64 * math::vertex_rounding * extent_m;
}

}  // namespace tenebra::bake
