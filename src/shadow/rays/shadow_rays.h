// Shadow rays of one light: the pixels it can reach, in the order of the cone tree's leaves.
// Olsson and Assarsson 2011, section 3.5.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>
#include "shadow/decision/triangle_planes.h"

namespace tenebra::shadow {

/// Rays of the pixels that the light reaches, in tree order.
struct ShadowRays {
  std::vector<std::uint32_t> pixels;
  std::vector<std::uint32_t> triangles;  ///< own triangle of each
  float tau_max = 0;                     ///< largest rounding tolerance of these triangles
};

/// Whether `p`, relative to a point or spot light, is within its cone and range: the part of a light's reach
/// that is not a matter of facing. Double, in one order of operations.
bool in_reach(const glm::dvec3& p, const ShadowLight& light);

/// How much of a ball, its centre relative to the light, is in_reach: all and none for sure, some perhaps.
enum class Reach : std::uint8_t { none, some, all };
Reach reach_of_ball(const glm::dvec3& centre, double radius, const ShadowLight& light);

/// Scratch of generate_shadow_rays and sort_shadow_rays.
struct RayKeys {
  std::vector<std::uint64_t> keys;  ///< key << 32 | pixel
  std::vector<std::uint64_t> other;
  std::vector<std::uint32_t> counts;
};

/// Compaction: pixels on the light's side of their triangle, or that see past it, within the light's
/// cone and range, in screen order along a Z curve (nearby pixels stay near). Pixels with the sample
/// at the light itself get no ray and are listed in `at_light`: nothing lies between. `set`: of `triangles`
/// and light.
void generate_shadow_rays(const VisiblePoints& points, const TriangleView& triangles,
                          const ShadowLight& light, const RaySource& source, const TriangleSet& set,
                          RayKeys& scratch, ShadowRays& out, std::vector<std::uint32_t>& at_light);

/// Orders the rays by the cube face and the Hilbert index of their direction (directional lights: by the
/// Hilbert index of their position across the light), ties in the order they had.
void sort_shadow_rays(const VisiblePoints& points, const RaySource& source, SimdLevel simd, RayKeys& scratch,
                      ShadowRays& rays);

/// Stable sort of `keys` by bits 32 to 62, on all cores.
void radix_sort(std::vector<std::uint64_t>& keys, RayKeys& scratch);

}  // namespace tenebra::shadow
