#include "soft/shafts/shaft_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/shafts/shaft_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "points/contact_rule.h"
#include "simd/dispatch.h"
#include "simd/double8-inl.h"
#include "soft/shafts/shaft_cull-inl.h"

#include <algorithm>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

// u = 2^-53. Reaches bound |coordinates| relative to the light's centre, `size` those of the edges. Vectors
// of three coordinates bounded by r and s have |a.b| <= 3 r s.

static_assert(block_size == 8, "a block fills the lanes of a Double8");

// Vertices relative to the light's centre: off by u |coordinate|.
struct Triangles {
  Vector8 v[3];
  Double8 reach, size;
};
SIMD_INLINE Triangles load_triangles(const TriangleBlock& block, const LightShape& light) {
  Triangles t;
  for (int k = 0; k < 3; ++k) {
    t.v[k].x = load_widened<Double8>(block.v[k][0]) - broadcast8(light.origin.x);
    t.v[k].y = load_widened<Double8>(block.v[k][1]) - broadcast8(light.origin.y);
    t.v[k].z = load_widened<Double8>(block.v[k][2]) - broadcast8(light.origin.z);
  }
  t.reach =
      load_widened<Double8>(block.largest) +
      broadcast8(std::max({std::abs(light.origin.x), std::abs(light.origin.y), std::abs(light.origin.z)}));
  t.size = load_widened<Double8>(block.size);
  return t;
}

// An edge's vector from the vertices' floats: the light's distance does not make it less precise.
SIMD_INLINE Vector8 edge(const TriangleBlock& block, int from, int to) {
  return {load_widened<Double8>(block.v[to][0]) - load_widened<Double8>(block.v[from][0]),
          load_widened<Double8>(block.v[to][1]) - load_widened<Double8>(block.v[from][1]),
          load_widened<Double8>(block.v[to][2]) - load_widened<Double8>(block.v[from][2])};
}

// Lanes of the triangle `id`.
SIMD_INLINE std::uint32_t lanes_of(const TriangleBlock& block, std::uint32_t id) {
  using Ids = Pack<std::int32_t, block_size>;
  return bits(eq(load<Ids>(reinterpret_cast<const std::int32_t*>(block.ids)),
                 broadcast<Ids>(static_cast<std::int32_t>(id))));
}

SIMD_INLINE Double8 reduce_min(const Double8& a, const Double8& b, const Double8& c) {
  return min(a, min(b, c));
}
SIMD_INLINE Double8 most(const Double8& a, const Double8& b, const Double8& c) {
  return max(a, max(b, c));
}

// n.(x - A) over the points and over the light (for a sun n.x), n = (B - A) x (C - A), as least and greatest
// value, both widened by their rounding: with edges off by u, each coordinate of n is off by 9 u size^2, and
// n.(x - A) by (27 for n + 18 for the products + 18 for x + 30 for sums) u size^2 (reach_A + reach_x).
struct PlaneRange {
  Double8 points_low, points_high, light_low, light_high;
  Double8 normal_length, size2;
};
SIMD_INLINE PlaneRange plane_range(const Shaft& shaft, const TriangleBlock& block, const Triangles& t) {
  const Vector8 n = cross(edge(block, 0, 1), edge(block, 0, 2));
  const Double8 at_corner = dot_unfused(n, t.v[0]);
  const Double8 at_centre = dot_unfused(n, broadcast8(shaft.cell.centre)) - at_corner;
  Double8 around = abs(dot_unfused(n, broadcast8(shaft.cell.axis[0])));
  around = around + abs(dot_unfused(n, broadcast8(shaft.cell.axis[1])));
  around = around + abs(dot_unfused(n, broadcast8(shaft.cell.axis[2])));
  PlaneRange r;
  r.size2 = t.size * t.size;
  const Double8 margin = r.size2 * ((t.reach + broadcast8(shaft.cell.reach)) * broadcast8(0x1p-46) +
                                    broadcast8(6 * shaft.cell.slack));
  around = around + margin;
  r.points_low = at_centre - around, r.points_high = at_centre + around;
  r.light_low = r.light_high = dot_unfused(n, broadcast8(shaft.light->vertices[0]));
  for (int k = 1; k < shaft.light->count; ++k) {
    const Double8 at = dot_unfused(n, broadcast8(shaft.light->vertices[k]));
    r.light_low = min(r.light_low, at), r.light_high = max(r.light_high, at);
  }
  const Double8 weight = broadcast8(shaft.light->weight);
  const Double8 light_margin =
      r.size2 * (weight * t.reach + broadcast8(shaft.light->reach)) * broadcast8(0x1p-46);
  r.light_low = r.light_low - weight * at_corner - light_margin;
  r.light_high = r.light_high - weight * at_corner + light_margin;
  r.normal_length = sqrt(dot_unfused(n, n));
  return r;
}

// theta for a receiver's tau, from below and from above: |n| is off by 16 u size^2, here and in the
// definition.
SIMD_INLINE Double8 tau_of(const TriangleBlock& block, double tau_receiver) {
  return load_widened<Double8>(block.largest) * broadcast8(points::contact_tau) + broadcast8(tau_receiver);
}
SIMD_INLINE Double8 theta_low(const TriangleBlock& block, const PlaneRange& r, double tau_least) {
  return tau_of(block, tau_least) *
         (r.normal_length * broadcast8(1 - 0x1p-49) - r.size2 * broadcast8(0x1p-48));
}
SIMD_INLINE Double8 theta_high(const TriangleBlock& block, const PlaneRange& r, double tau_most) {
  return tau_of(block, tau_most) *
         (r.normal_length * broadcast8(1 + 0x1p-49) + r.size2 * broadcast8(0x1p-48));
}

std::size_t drop_behind(std::span<const Receiver> receivers, const LightShape& light,
                        const TriangleBlock* blocks, std::span<const BlockRef> in, BlockRef* out) {
  std::size_t count = 0;
  for (const BlockRef& ref : in) {
    const TriangleBlock& block = blocks[ref.block];
    const Triangles t = load_triangles(block, light);
    const Double8 margin = t.reach * broadcast8(0x1p-49);
    std::uint32_t dropped = ref.lanes;
    for (const Receiver& receiver : receivers) {
      const Vector8 m = broadcast8(receiver.m);
      const Double8 top = most(dot_unfused(m, t.v[0]), dot_unfused(m, t.v[1]), dot_unfused(m, t.v[2]));
      dropped &= lt_bits(top + margin, broadcast8(receiver.limit)) |
                 (receiver.lifted ? 0u : lanes_of(block, receiver.triangle));
      if (dropped == 0) break;
    }
    if (const std::uint32_t lanes = ref.lanes & ~dropped; lanes != 0) out[count++] = {ref.block, lanes};
  }
  return count;
}

// f(P, Q) = ((a - Q) x e).(P - Q), the side of the line PQ of the edge a, a + e, over cell and light: affine
// in P and in Q, so its extremes are at the vertices (Theorem 1). With a, e, P, Q off by u it is
//   a x e.(P - Q) - (Q x e).P: 18 products of three coordinates, each off by 14 u.
// For a sun, whose Q have weight 0, it is -(a x e).Q - (Q x e).P.
struct SideRange {
  Double8 low, high;
};
SIMD_INLINE Double8 side_margin(const Shaft& shaft, const Triangles& t) {
  const double light = shaft.light->reach, cell = shaft.cell.reach, weight = shaft.light->weight;
  const double of_cell = weight * cell, of_slack = weight * shaft.cell.slack;
  return t.size * (t.reach * broadcast8((of_cell + light) * 0x1p-45 + 6 * of_slack) +
                   broadcast8(light * (cell * 0x1p-45 + 6 * shaft.cell.slack)));
}
SIMD_INLINE SideRange side_from(const Shaft& shaft, const Vector8& m, const Double8& at_light) {
  const Double8 centre = dot_unfused(m, broadcast8(shaft.cell.centre)) - at_light;
  Double8 around = abs(dot_unfused(m, broadcast8(shaft.cell.axis[0])));
  around = around + abs(dot_unfused(m, broadcast8(shaft.cell.axis[1])));
  around = around + abs(dot_unfused(m, broadcast8(shaft.cell.axis[2])));
  return {centre - around, centre + around};
}
SIMD_INLINE SideRange side_range(const Shaft& shaft, const Vector8& e, const Vector8& moment) {
  SideRange range{broadcast8(INFINITY), broadcast8(-INFINITY)};
  const Vector8 weighed = broadcast8(shaft.light->weight) * moment;
  for (int k = 0; k < shaft.light->count; ++k) {
    const Vector8 q = broadcast8(shaft.light->vertices[k]);
    const SideRange from = side_from(shaft, weighed - cross(q, e), dot_unfused(moment, q));
    range.low = min(range.low, from.low), range.high = max(range.high, from.high);
  }
  return range;
}

// Lanes whose edges the line between the centres of cell and light passes on their inner sides.
struct Sides {
  std::uint32_t front, back;
};
SIMD_INLINE Sides sides_of_centre(const Shaft& shaft, const Triangles& t) {
  const Double8 zero = broadcast8(0.0);
  const Vector8 centre = broadcast8(shaft.cell.centre);
  Vector8 v[3] = {t.v[0], t.v[1], t.v[2]}, to = centre;
  if (shaft.light->at_infinity()) {  // the same line from its other end
    for (Vector8& corner : v) corner = corner - centre;
    to = broadcast8(-shaft.light->middle);
  }
  const Double8 f[3] = {dot_unfused(cross(v[0], v[1]), to), dot_unfused(cross(v[1], v[2]), to),
                        dot_unfused(cross(v[2], v[0]), to)};
  return {lt_bits(zero, reduce_min(f[0], f[1], f[2])), lt_bits(most(f[0], f[1], f[2]), zero)};
}

// Tests on which side of the edges lines between cell and light pass: takes from `some` the triangles that no
// line crosses, and from `every` those that not every line crosses, from the front (f >= 0 at all edges) or
// from the back (f <= 0).
SIMD_INLINE void keep_crossed(const Shaft& shaft, const TriangleBlock& block, const Triangles& t, Sides& some,
                              Sides& every) {
  const Double8 zero = broadcast8(0.0), margin = side_margin(shaft, t);
  for (int k = 0; k < 3 && (some.front | some.back) != 0; ++k) {
    const Vector8 e = edge(block, k, (k + 1) % 3);
    const SideRange f = side_range(shaft, e, cross(t.v[k], e));
    const std::uint32_t front = lt_bits(margin, f.low), back = lt_bits(f.high, zero - margin);
    some.front &= ~back, every.front &= front;
    some.back &= ~front, every.back &= back;
  }
}

// With more blocks than this, testing the edges does not pay: next to nothing is dropped, and hardly ever
// all.
constexpr std::size_t few_blocks = 4;

std::size_t drop_beside(const Shaft& shaft, ContactRange contact, const TriangleBlock* blocks,
                        std::span<const BlockRef> in, BlockRef* out, std::uint32_t& dark) {
  const bool few = in.size() <= few_blocks;
  std::size_t count = 0;
  const Double8 zero = broadcast8(0.0);
  for (const BlockRef& ref : in) {
    const TriangleBlock& block = blocks[ref.block];
    const Triangles t = load_triangles(block, *shaft.light);
    const PlaneRange plane = plane_range(shaft, block, t);
    const Double8 theta = theta_low(block, plane, contact.least);
    Sides some{ref.lanes & bits(lt(theta, plane.points_high) & lt(plane.light_low, zero)),
               ref.lanes & bits(lt(theta, zero - plane.points_low) & lt(zero, plane.light_high))};
    Sides every = sides_of_centre(shaft, t);
    every.front &= some.front, every.back &= some.back;
    if (dark != no_triangle) every = {0, 0};
    if ((every.front | every.back) != 0) {
      const Double8 sure = theta_high(block, plane, contact.most);
      every.front &= bits(lt(sure, plane.points_low) & lt(plane.light_high, zero));
      every.back &= bits(lt(sure, zero - plane.points_high) & lt(zero, plane.light_low));
    }
    if (few || (every.front | every.back) != 0) keep_crossed(shaft, block, t, some, every);
    if ((every.front | every.back) != 0) dark = block.ids[std::countr_zero(every.front | every.back)];
    if ((some.front | some.back) != 0) out[count++] = {ref.block, some.front | some.back};
  }
  return count;
}

}  // namespace

ShaftKernels shaft_kernels() {
  return {cull, drop_behind, drop_beside};
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

ShaftKernels shaft_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, shaft_kernels)();
}

}  // namespace tenebra::soft
#endif
