// The public entry of the hard shadows: visible points and triangles in, a mask out. No OpenGL.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/frame_timings.h"

namespace tenebra {

/// No triangle is seen at this pixel, or the sample belongs to none.
inline constexpr std::uint32_t no_triangle = 0xffffffffu;

/// Occluders: float vertices, taken as exact. Zero-area triangles block nothing.
struct Occluders {
  std::span<const glm::vec3> positions;
  std::span<const glm::uvec3> triangles;
  std::span<const std::uint8_t> casts_shadow;  ///< one a triangle; empty: all cast
};

/// What the rays of a light share: their end (`position`), or their direction towards the light (`to_light`).
struct ShadowLight {
  bool directional = false;
  glm::vec3 position{0.0f};   ///< point and spot: exact
  glm::vec3 to_light{0, 1, 0};///< directional: exact, any length but zero
  /// Spots and ranges: points outside are not reached (no ray, mask 0).
  glm::vec3 spot_axis{0, -1, 0};
  float spot_cos_outer = -1.0f;
  float range_m = 0.0f;       ///< 0: unbounded
};

/// Samples, one a pixel: point in double, taken as exact, and the triangle it lies on.
struct VisiblePoints {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec3> positions;      ///< width * height; meaningless where the id is no_triangle
  std::vector<std::uint32_t> triangles;   ///< width * height
};


enum class Variant {
  precise, precise_sorted, spheres, spheres_sorted, precise_sea, precise_eatp, precise_seatp,
};
std::string_view variant_name(Variant variant);                       ///< the paper's name, Table 1
std::optional<Variant> variant_from_name(std::string_view name);

enum class SimdLevel { automatic, scalar, sse4, avx2, avx512 };

struct HardShadowConfig {
  Variant variant = Variant::precise_sorted;
  bool cull_front = false;                 ///< section 3.6: only triangles that face away from the light cast
  SimdLevel simd = SimdLevel::automatic;
};

/// One a pixel: 255 the point sees the light; 0 blocked, facing away, not reached, or no triangle.
using ShadowMask = std::vector<std::uint8_t>;

}  // namespace tenebra
