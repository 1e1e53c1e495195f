// Boxes, triangles and tiles of points on the distant face, sixteen at a time, in float. All are true bounds:
// they include the errors of floats. u = 2^-24 below. Included once per target.
#if defined(TENEBRA_DISTANT_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_DISTANT_TESTS_INL_H_
#undef TENEBRA_DISTANT_TESTS_INL_H_
#else
#define TENEBRA_DISTANT_TESTS_INL_H_
#endif

#include <bit>

#include "shadow/tiles/distant_face.h"
#include "shadow/tiles/face_tests-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// What reaches nearer to the light than nearest_share of the light's distance, or has coordinates that add
/// up to farthest_coordinate, gets a box that meets all rays.
constexpr float nearest_share = 0x1p-10f, farthest_coordinate = 1e30f;

/// Sixteen ranges of a coordinate relative to the face's origin. Each end is off by u of itself.
struct DistantRange {
  Float16 low, high;
};
SIMD_INLINE Float16 largest_of(const DistantRange& r) {
  return max(abs(r.low), abs(r.high));
}
SIMD_INLINE DistantRange scaled(const DistantRange& r, float by) {
  const Float16 a = r.low * broadcast<Float16>(by), b = r.high * broadcast<Float16>(by);
  return {min(a, b), max(a, b)};
}

/// 1 / q where z is at its ends; q = 1 - K z.
struct Nearness {
  Float16 near_q, far_q;  ///< at the largest and the smallest z
  Float16 near_inverse, far_inverse;
};
SIMD_INLINE Nearness nearness_of(const DistantRange& z, const DistantFace& f) {
  const Float16 one = broadcast<Float16>(1.0f), k = broadcast<Float16>(f.k),
                least = broadcast<Float16>(nearest_share);
  Nearness n;
  n.near_q = one - k * z.high, n.far_q = one - k * z.low;
  n.near_inverse = one / max(n.near_q, least), n.far_inverse = one / max(n.far_q, least);
  return n;
}

/// u or v of boxes with x (or y) and z within their ranges; `s`: S or T.
SIMD_INLINE DistantRange sheared(const DistantRange& x, const DistantRange& z, float s, const Nearness& n) {
  const DistantRange shift = scaled(z, s);
  const Float16 low = x.low - shift.high, high = x.high - shift.low, zero = broadcast<Float16>(0.0f);
  return {low * select_le(zero, low, n.far_inverse, n.near_inverse),
          high * select_le(high, zero, n.far_inverse, n.near_inverse)};
}

/// How far the coordinate u is off where x, z, S, K and each operation have the relative error u = 2^-24.
/// With A = |x| + |S z| the numerator is off by 4.1u A, q by 3.1u |K z| + u q <= u (3.1 + 4.2 q), so 1 / q by
/// (3.1 / q + 5.2) u of itself: in all (10.4 + 3.1 / q) u A / q, with A and 1 / q themselves off by less than
/// 2^-11. w = z / q: the same with |z|.
SIMD_INLINE Float16 distant_margin(Float16 size, Float16 inverse) {
  return broadcast<Float16>(16 * u) * size * inverse * max(inverse, broadcast<Float16>(1.0f));
}

/// Puts boxes on the face: their ranges of u and v, widened by margins from the largest coordinates (`size`)
/// and 1 / q. Boxes too near the light or too far away get `all`.
SIMD_INLINE void set_boxes(const DistantRange across[2], Float16 w, const Float16 size[3], const Nearness& n,
                           const DistantFace& f, const FaceBox& all, FaceBoxes& out) {
  const Float16 depth = size[2];
  const Float16 u_margin =
                    distant_margin(size[0] + depth * broadcast<Float16>(std::abs(f.s)), n.near_inverse),
                v_margin =
                    distant_margin(size[1] + depth * broadcast<Float16>(std::abs(f.t)), n.near_inverse);
  const auto sane = le(broadcast<Float16>(nearest_share), n.near_q) &
                    lt(size[0] + size[1] + size[2], broadcast<Float16>(farthest_coordinate));
  out.u0 = select(sane, across[0].low - u_margin, broadcast<Float16>(all.u0));
  out.u1 = select(sane, across[0].high + u_margin, broadcast<Float16>(all.u1));
  out.v0 = select(sane, across[1].low - v_margin, broadcast<Float16>(all.v0));
  out.v1 = select(sane, across[1].high + v_margin, broadcast<Float16>(all.v1));
  out.w = select(sane, w + distant_margin(abs(w), max(n.near_inverse, broadcast<Float16>(1.0f))),
                 broadcast<Float16>(all.w));
}

/// Bits of the boxes that are not certainly behind the light: q < -1 throughout is.
SIMD_INLINE std::uint32_t before_light(const Nearness& n) {
  return 0xffffu & ~lt_bits(n.far_q, broadcast<Float16>(-1.0f));
}

/// World-space boxes on the face; returns the bits of those that are not empty or behind the light.
SIMD_INLINE std::uint32_t project_boxes(const BoxNode& node, const DistantFace& f, FaceBoxes& out) {
  DistantRange r[3];
  for (int k = 0; k < 3; ++k) {
    const Float16 origin = broadcast<Float16>(f.origin[f.axes[k]]);
    r[k] = {load<Float16>(node.low[f.axes[k]]) - origin, load<Float16>(node.high[f.axes[k]]) - origin};
  }
  const Float16 zero = broadcast<Float16>(0.0f);
  if (f.sign < 0) r[2] = {zero - r[2].high, zero - r[2].low};
  const Nearness n = nearness_of(r[2], f);
  const DistantRange across[2] = {sheared(r[0], r[2], f.s, n), sheared(r[1], r[2], f.t, n)};
  const Float16 size[3] = {largest_of(r[0]), largest_of(r[1]), largest_of(r[2])};
  constexpr float open = farthest_coordinate;
  set_boxes(across, r[2].high * n.near_inverse, size, n, f, {-open, open, -open, open, open}, out);
  return bits(le(r[2].low, r[2].high)) & before_light(n);
}

/// Boxes of a cluster's triangles themselves: tighter than its box by far. Those that reach near the light
/// get `all`. Returns the bits of those that are not behind it.
SIMD_INLINE std::uint32_t project_triangles(const TriangleCluster& c, const DistantFace& f,
                                            const FaceBox& all, FaceBoxes& out) {
  const float(*const corners[3])[16] = {c.x, c.y, c.z};
  const Float16 one = broadcast<Float16>(1.0f), sign = broadcast<Float16>(f.sign);
  const Pack3<Float16> origin =
      broadcast3<Float16>(f.origin[f.axes[0]], f.origin[f.axes[1]], f.origin[f.axes[2]]);
  DistantRange across[2], depth;
  Float16 size[3];
  for (int k = 0; k < 3; ++k) {
    const Float16 x = load<Float16>(corners[f.axes[0]][k]) - origin.x,
                  y = load<Float16>(corners[f.axes[1]][k]) - origin.y,
                  z = (load<Float16>(corners[f.axes[2]][k]) - origin.z) * sign;
    const Float16 inverse = one / max(one - broadcast<Float16>(f.k) * z, broadcast<Float16>(nearest_share));
    const Float16 pu = (x - broadcast<Float16>(f.s) * z) * inverse,
                  pv = (y - broadcast<Float16>(f.t) * z) * inverse;
    across[0] = k == 0 ? DistantRange{pu, pu} : DistantRange{min(across[0].low, pu), max(across[0].high, pu)};
    across[1] = k == 0 ? DistantRange{pv, pv} : DistantRange{min(across[1].low, pv), max(across[1].high, pv)};
    depth = k == 0 ? DistantRange{z, z} : DistantRange{min(depth.low, z), max(depth.high, z)};
    size[0] = k == 0 ? abs(x) : max(size[0], abs(x));
    size[1] = k == 0 ? abs(y) : max(size[1], abs(y));
  }
  size[2] = largest_of(depth);
  const Nearness n = nearness_of(depth, f);
  set_boxes(across, depth.high * n.near_inverse, size, n, f, all, out);
  return c.used & before_light(n);
}

/// A cluster's triangles on the face. With the values at p over q, edges are m.x u + m.y v - d for planes
/// that do go through the light; the own plane is m.x u + m.y v - d - c w with c = d K - m.(S, T, 1) >= 0.
/// Both are as on the cube (FaceCluster) with -d in place of m.z, and c in place of d.
///
/// Errors: m and d of a plane are off by less than rho / 2 and rho / 2 reach, so the values by rho (across +
/// 3 along + 1.1 reach). Floats and roundings add 5.1u (across + |d|); c is off by 15.3u + 4.1u |d| K, and
/// its product with w rounded: 18.3u along + 0.3u |d|. Together below (7u + 1.1 rho) (across + 3 along +
/// reach). d includes tau, and 1 / q is 16/17 to 16/15: what is over tau / q need not be over tau, but by tau
/// / 16.
SIMD_INLINE void face_cluster(const ClusterPlanes& c, const DistantFace& f, float tau, FaceCluster& out) {
  const float(*const m[3])[16] = {c.fx, c.fy, c.fz};
  const Float16 zero = broadcast<Float16>(0.0f);
  for (int k = 0; k < 4; ++k) {
    store(load<Float16>(m[f.axes[0]][k]), out.mx[k]);
    store(load<Float16>(m[f.axes[1]][k]), out.my[k]);
    store(zero - load<Float16>(c.fd[k]), out.mz[k]);
  }
  const Float16 mx = load<Float16>(out.mx[3]), my = load<Float16>(out.my[3]),
                mz = load<Float16>(m[f.axes[2]][3]) * broadcast<Float16>(f.sign);
  const Float16 climb = mul_add(mx, broadcast<Float16>(f.s), mul_add(my, broadcast<Float16>(f.t), mz));
  const Float16 per_w = load<Float16>(c.fd[3]) * broadcast<Float16>(f.k) - climb;
  store(per_w, out.d), store(per_w, out.cover);
  const Float16 size = broadcast<Float16>(f.across + 3 * f.along) + load<Float16>(c.reach);
  const Float16 slack =
      mul_add(broadcast<Float16>(1.12f), load<Float16>(c.rho), broadcast<Float16>(7.1f * u)) * size +
      broadcast<Float16>(0x1p-122f);
  const Float16 own_slack = mul_add(broadcast<Float16>(0.125f), load<Float16>(c.tau), slack);
  store(slack, out.edge_slack), store(own_slack, out.own_slack);
  store(own_slack + broadcast<Float16>(1.1f * tau), out.cover_slack);
}

/// Bounds of a coordinate of a square's points relative to the origin: as range_of, with the same margins.
struct TileRange {
  DistantRange at;
  float size;  ///< >= |coordinate|
};
SIMD_INLINE TileRange tile_range(const points::PointSquare& square, const DistantFace& f, int k) {
  const int axis = f.axes[k];
  const auto base =
      static_cast<float>(static_cast<double>(square.base.at[axis]) - static_cast<double>(f.origin[axis]));
  const float size = std::abs(base) + square.base.grain;
  const Float16 centre = broadcast<Float16>(base), margin = broadcast<Float16>(5 * u * size);
  const DistantRange r{centre + load<Float16>(square.low[axis]) - margin,
                       centre + load<Float16>(square.high[axis]) + margin};
  const Float16 zero = broadcast<Float16>(0.0f);
  if (k == 2 && f.sign < 0) return {{zero - r.high, zero - r.low}, size};
  return {r, size};
}

/// Margins of u, v and w of points within x, y, z <= size, where the ranges are true bounds or coordinates
/// off by 3u size. 1 / q <= 16/15; numerators are off by 4.1u |x| + 6.2u |S z|, 1 / q by 2.6u of itself, the
/// quotient by u more: below 8.6u |x| + 10.9u |S z|. w is off by 7.5u |z|.
struct TileMargins {
  float u, v, w;
};
SIMD_INLINE TileMargins tile_margins(const float size[3], const DistantFace& f) {
  const float depth = size[2];
  return {12 * u * (size[0] + std::abs(f.s) * depth), 12 * u * (size[1] + std::abs(f.t) * depth),
          12 * u * depth};
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
