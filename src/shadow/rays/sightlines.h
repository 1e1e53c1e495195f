// Why a sample sees a light or not: the way from one sample to a light, with the first triangle that blocks
// it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>

namespace tenebra::shadow {

/// A place in world space, taken as exact, on a triangle.
struct Sample {
  glm::dvec3 point{0.0};
  std::uint32_t triangle = no_triangle;
  int side = 0;  ///< of the triangle: visible_side()
};

/// What a mask's value means: `lit` is 255, all others are 0.
enum class LightSight : std::uint8_t {
  lit,
  faces_away,    ///< the light is not strictly on the sample's side of its triangle, or that has no area;
                 ///< and where it was lifted off a smooth one, that triangle is in its way
  out_of_reach,  ///< beyond the light's range or outside of its cone
  blocked,
};

struct Sightline {
  LightSight sight = LightSight::lit;
  std::uint32_t blockers = 0;  ///< triangles that block it; 0 but for `blocked`
  /// The triangle, of these, that is met first on the way from the sample: the smallest id of those that are
  /// met at once; exact.
  std::uint32_t first = no_triangle;
  glm::dvec3 met_at{0.0};  ///< where the way meets the plane of `first`, in double; for display
};

/// The way from `sample` to each of `lights`, by the contract of ShadowTracer::trace_shadow_mask: a sightline
/// is lit exactly where the mask has 255. Looks at every triangle once, on all threads; the answer does not
/// depend on their number.
std::vector<Sightline> find_sightlines(const Sample& sample, const TriangleView& triangles,
                                       std::span<const ShadowLight> lights, const HardShadowConfig& config);

}  // namespace tenebra::shadow
