#include "soft/light/even_emission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "parallel/parallel.h"
#include "soft/light/even_kernels.h"

namespace tenebra::soft {
namespace {

using glm::dvec3;

/// Up to 14 vertices, and one more for the cut by a plane. Rounding makes more where that is the polygon's
/// own plane: those are left out, as all of the polygon is seen edge-on then.
struct Corners {
  std::array<dvec3, 16> at;
  std::size_t count = 0;
  void add(const dvec3& corner) {
    if (count < at.size()) at[count++] = corner;
  }
  const dvec3& after(std::size_t i) const { return at[i + 1 < count ? i + 1 : 0]; }
};

// Elementary functions by their series alone, so that every machine has the same bits. Both halve the result
// until the argument is at most 0.2: the first term left out is at most 0.2^20 / 21 = 5e-16 of the first one.

double series(double q, double sign) {
  const double y = sign * q * q;
  double sum = 0;
  for (int k = 19; k >= 3; k -= 2) sum = (sum + 1.0 / k) * y;
  return q * (1 + sum);
}
/// The angle of (x, y), y >= 0: 0 to pi.
double angle_of(double x, double y) {
  const double low = std::min(std::abs(x), y), high = std::max(std::abs(x), y);
  if (!(high > 0)) return 0;
  double q = low / high, scale = 1;
  while (q > 0.2) {
    q = q / (1 + std::sqrt(1 + q * q));
    scale *= 2;
  }
  double angle = scale * series(q, -1);
  if (y > std::abs(x)) angle = 0.5 * std::numbers::pi - angle;
  return x < 0 ? std::numbers::pi - angle : angle;
}
/// Inverse hyperbolic tangent of 0 <= q <= 1; for 1, its value at 1 - 2^-52.
double artanh(double q) {
  q = std::min(q, 1 - 0x1p-52);
  double scale = 1;
  while (q > 0.2) {
    q = q / (1 + std::sqrt((1 - q) * (1 + q)));
    scale *= 2;
  }
  return scale * series(q, 1);
}

/// The part of the light's polygon that lies on the normal's side of `at`, relative to `at`.
Corners seen_above(const AreaLight& light, const dvec3& at, const dvec3& normal) {
  Corners whole, above;
  const dvec3 way = light.at_infinity ? light.centre : light.centre - at;
  for (const glm::dvec2& v : light.polygon) {
    if (whole.count < 14) whole.add(way + v.x * light.ex + v.y * light.ey);
  }
  for (std::size_t i = 0; i < whole.count; ++i) {
    const dvec3 a = whole.at[i], b = whole.after(i);
    const double at_a = glm::dot(normal, a), at_b = glm::dot(normal, b);
    if (at_a >= 0) above.add(a);
    if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) above.add(a + at_a / (at_a - at_b) * (b - a));
  }
  return above;
}

/// The polygon's solid angle, by a fan of triangles (Van Oosterom and Strackee 1983); positive if seen from
/// the light's front.
double solid_angle(const Corners& corners, const dvec3& light_normal) {
  double sum = 0;
  const dvec3 a = corners.at[0];
  const double la = glm::length(a);
  for (std::size_t i = 1; i + 1 < corners.count; ++i) {
    const dvec3 b = corners.at[i], c = corners.at[i + 1];
    const double lb = glm::length(b), lc = glm::length(c);
    const double volume = glm::dot(a, glm::cross(b, c));
    const double rest = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    sum += 2 * angle_of(rest, std::abs(volume));
  }
  return glm::dot(a, light_normal) < 0 ? sum : -sum;
}

}  // namespace

AreaLight reversed(const AreaLight& light) {
  std::vector<glm::vec3> vertices(light.vertices.rbegin(), light.vertices.rend());
  return make_area_light(vertices).value_or(light);
}

bool any_behind(const VisiblePoints& points, const AreaLight& light) {
  for (std::size_t i = 0; i < points.triangles.size(); ++i)
    if (points.triangles[i] != no_triangle && glm::dot(light.normal, points.positions[i] - light.centre) < 0)
      return true;
  return false;
}

/// The integral of q / |q|^3 over a polygon is, along its normal, the solid angle, and within its plane, by
/// the divergence theorem, minus the sum over the edges of their outward normal times the integral of 1 / |q|
/// along the edge: 2 artanh(length / (|q0| + |q1|)). (The attraction of a uniform plate.)
double even_irradiance(const AreaLight& light, const dvec3& at, const dvec3& normal) {
  const Corners corners = seen_above(light, at, normal);
  if (corners.count < 3) return 0;
  double sum = -glm::dot(normal, light.normal) * solid_angle(corners, light.normal);
  for (std::size_t i = 0; i < corners.count; ++i) {
    const dvec3 a = corners.at[i], b = corners.after(i), edge = b - a;
    const double length = glm::length(edge), ways = glm::length(a) + glm::length(b);
    if (!(length > 0)) continue;
    const dvec3 outward = glm::cross(edge, light.normal) / length;
    sum -= glm::dot(normal, outward) * 2 * artanh(length / ways);
  }
  return std::max(sum, 0.0);
}

/// Nishita and Nakamae's sum over the edges (1985).
double whole_irradiance(const AreaLight& light, const dvec3& at, const dvec3& normal) {
  const Corners corners = seen_above(light, at, normal);
  double sum = 0;
  for (std::size_t i = 0; i < corners.count; ++i) {
    const dvec3 a = corners.at[i], b = corners.after(i), across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += glm::dot(normal, across) / sine * angle_of(glm::dot(a, b), sine);
  }
  return 0.5 * std::abs(sum);
}

void weigh_evenly(const VisiblePoints& points, std::span<const glm::vec3> normals, const AreaLight& light,
                  SimdLevel simd, SoftMask& mask) {
  const parallel::FloatEnvironment ieee;
  const EvenRectangle rectangle = even_rectangle(light);
  const EvenKernel kernel = even_kernel(simd);
  parallel::parallel_ranges(points.triangles.size(), 1 << 12, [&](std::size_t first, std::size_t last) {
    EvenBlock block;
    for (std::size_t i = first; i < last; ++i) {
      if (mask.irradiance[i] > 0) block.add(rectangle, static_cast<std::uint32_t>(i), points, normals);
      if (block.count < EvenBlock::capacity && (i + 1 < last || block.count == 0)) continue;
      std::uint32_t by_rule = kernel(rectangle, block);
      for (std::size_t k = 0; k < block.count; ++k, by_rule >>= 1) {
        const std::uint32_t pixel = block.pixels[k];
        const dvec3 at = points.positions[pixel], normal(normals[pixel]);
        const double all = (by_rule & 1) != 0 ? block.irradiance[k] : even_irradiance(light, at, normal);
        double share = 1;
        if (mask.visible_fraction[pixel] < 1) {
          const double whole = whole_irradiance(light, at, normal);
          share = whole > 0 ? std::min(1.0, mask.irradiance[pixel] / whole) : 0.0;
        }
        mask.irradiance[pixel] = static_cast<float>(share * all);
      }
      block.count = 0;
    }
  });
}

}  // namespace tenebra::soft
