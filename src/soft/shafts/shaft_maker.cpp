#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/shafts/shaft_maker.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <cmath>
#include "simd/dispatch.h"

#include "simd/double8-inl.h"
#include "soft/shafts/shaft.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using glm::dvec3;

// The corner of the cell, and the vertex of the light, farthest along m.
SIMD_INLINE Vector8 farthest(const Cell& cell, const Vector8& m) {
  Vector8 corner = broadcast8(cell.centre);
  for (const dvec3& a : cell.axis) {
    const Vector8 axis = broadcast8(a);
    corner = corner + select3(lt(broadcast8(0.0), dot_unfused(m, axis)), axis, broadcast8(-a));
  }
  return corner;
}
SIMD_INLINE Vector8 farthest(const LightShape& light, const Vector8& m) {
  Vector8 best = broadcast8(light.vertices[0]);
  Double8 most = dot_unfused(m, best);
  for (int k = 1; k < light.count; ++k) {
    const Vector8 vertex = broadcast8(light.vertices[k]);
    const Double8 along = dot_unfused(m, vertex);
    const auto more = lt(most, along);
    best = select3(more, vertex, best), most = select(more, along, most);
  }
  return best;
}

// The two planes parallel to each edge of the cell that touch cell and light, and the light's own. The
// touching corners are searched from the normal across the line between the centres; each step turns the
// plane towards them.
SIMD_INLINE Vector8 tangents(const Cell& cell, const LightShape& light) {
  double lanes[3][8] = {};
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      lanes[axis][2 * k] = cell.axis[k][axis];
      lanes[axis][2 * k + 1] = -cell.axis[k][axis];
    }
  const Vector8 along{load<Double8>(lanes[0]), load<Double8>(lanes[1]), load<Double8>(lanes[2])};
  Vector8 m = cross(along, broadcast8(cell.centre));
  for (int step = 0; step < 2; ++step) m = cross(along, farthest(cell, m) - farthest(light, m));
  const auto own = mask_of_bits<double, 8>(1u << 6);
  return select3(own, broadcast8(-light.normal), m);
}

// The planes through edges `first` to first + 7 of the light that touch the cell: m = o - t normal, t the
// largest (x.o) / (x.normal) of the corners x seen from the edge.
SIMD_INLINE Vector8 light_edges(const Cell& cell, const LightShape& light, int first) {
  const Vector8 o{load<Double8>(light.across[0] + first), load<Double8>(light.across[1] + first),
                  load<Double8>(light.across[2] + first)};
  const Double8 at_edge = load<Double8>(light.at_edge + first);
  Double8 t = broadcast8(-INFINITY);
  for (int k = 0; k < 8; ++k) {
    const dvec3 corner = cell.centre + (k & 1 ? cell.axis[0] : -cell.axis[0]) +
                         (k & 2 ? cell.axis[1] : -cell.axis[1]) + (k & 4 ? cell.axis[2] : -cell.axis[2]);
    const double height = glm::dot(corner, light.normal);
    if (!(height > 0)) return broadcast8(dvec3(0));
    t = max(t, (dot_unfused(o, broadcast8(corner)) - at_edge) * broadcast8(1 / height));
  }
  return subtract_scaled(o, t, broadcast8(light.normal));
}

// For a sun, the planes along the edges of its directions: m.q = 0 for the vertices q at one edge, less for
// the others, all by 2^-46 |m| less, so that rounding (16 u |m| at most, as |q| <= sqrt 3) leaves none above
// 0 and the plane bounds the shaft at any distance.
SIMD_INLINE Vector8 sun_edges(const LightShape& light, int first) {
  const Vector8 o{load<Double8>(light.across[0] + first), load<Double8>(light.across[1] + first),
                  load<Double8>(light.across[2] + first)};
  const Double8 at_edge = load<Double8>(light.at_edge + first);
  const Double8 margin = broadcast8(0x1p-46) * (l1_norm(o) + abs(at_edge));
  return subtract_scaled(o, broadcast8(0) - at_edge - margin, broadcast8(light.normal));
}

// Any m gives a valid plane: its limit is the farthest that the shaft reaches along m. For a sun, any m that
// does not rise along its directions: it is then the cell that reaches farthest.
SIMD_INLINE void add_planes(const Vector8& m_unscaled, Shaft& shaft) {
  const Double8 size = l1_norm(m_unscaled);
  const auto there = lt(broadcast8(0x1p-900), size) & lt(size, broadcast8(0x1p900));
  const Double8 scale =
      select(there, broadcast8(1 - 0x1p-50) / select(there, size, broadcast8(1)), broadcast8(0));
  const Vector8 m = scale * m_unscaled;
  Double8 most = dot_unfused(m, broadcast8(shaft.cell.centre)) + broadcast8(shaft.cell.slack);
  for (const dvec3& a : shaft.cell.axis) most = most + abs(dot_unfused(m, broadcast8(a)));
  for (int k = 0; k < shaft.light->count && !shaft.light->at_infinity(); ++k)
    most = max(most, dot_unfused(m, broadcast8(shaft.light->vertices[k])));
  most = most +
         broadcast8(0x1p-49 * (shaft.cell.reach + shaft.light->place_reach() + largest(shaft.light->origin)));
  double x[8], y[8], z[8], limit[8];
  store(m.x, x), store(m.y, y), store(m.z, z), store(most, limit);
  const std::uint32_t valid = bits(there);
  for (int k = 0; k < 8; ++k)
    if ((valid >> k & 1) != 0) shaft.planes[shaft.plane_count++] = {{x[k], y[k], z[k]}, limit[k]};
}

void extend_to_sun(const LightShape& light, Shaft& shaft) {
  constexpr double least = 0x1p-46;  // directions are known within 2^-50
  for (int axis = 0; axis < 3; ++axis) {
    if (light.low[axis] < least) shaft.low[axis] = -INFINITY;
    if (light.high[axis] > -least) shaft.high[axis] = INFINITY;
  }
  for (int first = 0; first < light.count; first += 8) add_planes(sun_edges(light, first), shaft);
  const auto one = mask_of_bits<double, 8>(1u);
  add_planes(select3(one, broadcast8(light.normal), broadcast8(dvec3(0))), shaft);
}

Shaft shaft_around(const Cell& cell, const LightShape& light) {
  Shaft shaft;
  shaft.cell = cell;
  shaft.light = &light;
  const dvec3 half = glm::abs(cell.axis[0]) + glm::abs(cell.axis[1]) + glm::abs(cell.axis[2]);
  const double margin = cell.slack + 0x1p-49 * (cell.reach + light.place_reach() + largest(light.origin));
  if (light.at_infinity()) {
    shaft.low = cell.centre - half - margin;
    shaft.high = cell.centre + half + margin;
    extend_to_sun(light, shaft);
    return shaft;
  }
  shaft.low = glm::min(light.low, cell.centre - half) - margin;
  shaft.high = glm::max(light.high, cell.centre + half) + margin;
  for (int first = 0; first < light.count; first += 8) add_planes(light_edges(cell, light, first), shaft);
  add_planes(tangents(cell, light), shaft);
  return shaft;
}

}  // namespace

ShaftMaker shaft_maker() {
  return shaft_around;
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

ShaftMaker shaft_maker(SimdLevel level) {
  return TENEBRA_DISPATCH(level, shaft_maker)();
}

}  // namespace tenebra::soft
#endif
