// Points of a tile in float, from planes as pixels see them. Included once per target.
//
// With inv = 1 / s in the tile's middle and pixels (i, j) from there, i and j of -1.5 ... 1.5:
//   q = c + (i ex + j ey) / (1 + i sx + j sy),
// where c is the q of the middle, sx = (n.dx) inv, sy = (n.dy) inv, t = height inv, ex = t (dx - sx d) and
// ey = t (dy - sy d) with the direction d of the middle. Only what depends on i and j is in float.
//
// What doubles are off, with e = 2^-53, all sizes L1 norms, N = |n| longest, A = |a - eye|, T = |t| longest
// and g = N |inv|, which is >= 1. Height is off by 5 e |n| A, s (in the scalar code and here) by 8 e N, and
// at the pixels it is at least 7/8 of that in the middle. So the scalar code's t d is off by e g (5.8 A
// + 10.5 T) + 6 e T, and its point by e g (6 A + 19 T) + e |eye|; c by that and by 2 e (|eye| + |base|); ex
// and ey, of which 1.5 times is at most T g / 2, with sx and sy by 13 e g T more in all. Together below 2^-46
// g (A + T) + 2^-50 (|eye| + |base|) = off.
//
// u = du.(p - a) of the scalar code is off by at most |du| (off + 5 e (A + 1.2 T)) < 2 |du| off, its value
// here by 40 e |du| g (A + T) < |du| off, v likewise, 1 - u - v by their sum and 2^-46 g. Times s inv, which
// is at least 7/8, all three are linear: where they exceed 4 ((|du| + |dv|) off +
// 2^-46 g) in the corners of the tile, no weight of a pixel is negative in the scalar code, and its point is
// not moved.
//
// Floats: with m = 1.5 (|ex| + |ey|), u = 2^-24 and |i sx + j sy| <= 1/8, the divisor is off by 1.5 u, so by
// 1.72 u of itself, its inverse by 2.72 u; i ex + j ey by 3 u m; the product is at most 8/7 m and off by
// 7.7 u m. c is rounded, and so is the sum: q is off by u (|c| + |q| + 8 m) + off, and |c| is at most the
// largest |q| of the tile. Of a tile of several receivers it may exceed that, where the middle is beside the
// triangle, by 8/7 m: together at most u (2 |q| + 10 m) + off (grain_of).
#if defined(TENEBRA_SEEN_PLANE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SEEN_PLANE_INL_H_
#undef TENEBRA_SEEN_PLANE_INL_H_
#else
#define TENEBRA_SEEN_PLANE_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "points/seen_plane.h"
#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::points::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

using Double4 = Pack<double, 4>;
using Vector16 = Pack3<Float16>;

/// Pixels of a tile from its middle.
struct TileLanes {
  Float16 i, j;

  TileLanes() {
    alignas(64) static constexpr float columns[16] = {-1.5f, -0.5f, 0.5f, 1.5f, -1.5f, -0.5f, 0.5f, 1.5f,
                                                      -1.5f, -0.5f, 0.5f, 1.5f, -1.5f, -0.5f, 0.5f, 1.5f},
                                       lines[16] = {-1.5f, -1.5f, -1.5f, -1.5f, -0.5f, -0.5f, -0.5f, -0.5f,
                                                    0.5f,  0.5f,  0.5f,  0.5f,  1.5f,  1.5f,  1.5f,  1.5f};
    i = load<Float16>(columns), j = load<Float16>(lines);
  }
  SIMD_INLINE Float16 linear(float by_x, float by_y) const {
    return mul_add(i, broadcast<Float16>(by_x), j * broadcast<Float16>(by_y));
  }
};

/// The middle of the tile with first pixel `at`, and its direction.
struct TileMiddle {
  double x, y;
  Double4 px, py, d;

  SIMD_INLINE TileMiddle(const RayRows& rows, glm::uvec2 at)
      : x(static_cast<double>(at.x) + 2),
        y(static_cast<double>(at.y) + 2),
        px(broadcast<Double4>(x)),
        py(broadcast<Double4>(y)),
        d(load<Double4>(rows.d0) + (px * load<Double4>(rows.dx) + py * load<Double4>(rows.dy))) {}
};

/// Where the middle's ray meets a plane.
struct Crossing {
  double inv, size, t, off, least;  ///< size: |inv|; least: weights times s inv that exceed it are positive
  bool good;                        ///< s changes by less than 1/8 across the tile, and nothing is too large

  SIMD_INLINE Crossing(const SeenPlane& plane, const SquareEye& eye, const TileMiddle& at)
      : inv(1 / (plane.at0[3] + (at.x * plane.dx[3] + at.y * plane.dy[3]))),
        size(std::abs(inv)),
        t(plane.height * inv) {
    const double g = plane.normal * size, reach = plane.height_reach * size;
    off = 0x1p-46 * (g * (plane.distance + reach)) + eye.rounding;
    least = 4 * (plane.weights * off + 0x1p-46 * g);
    good = t > 0 && reach < 0x1p100 && plane.half[3] * size < 0.124;
  }
};

/// Weights of the middle, times s inv = 1.
SIMD_INLINE Double4 weights_of(const SeenPlane& plane, const TileMiddle& at, const Crossing& c) {
  return (load<Double4>(plane.at0) + (at.px * load<Double4>(plane.dx) + at.py * load<Double4>(plane.dy))) *
         broadcast<Double4>(c.inv);
}

/// Whether all sixteen points lie inside the triangle for certain.
SIMD_INLINE bool corners_inside(const SeenPlane& plane, const TileMiddle& at, const Crossing& c) {
  const Double4 least = weights_of(plane, at, c) - load<Double4>(plane.half) * broadcast<Double4>(c.size);
  return bits(le(broadcast<Double4>(c.least), least)) == 0xfu;
}

/// Lanes whose points do. Their weights in float are off by less than 8 u of the largest terms.
SIMD_INLINE std::uint32_t lanes_inside(const SeenPlane& plane, const TileMiddle& at, const Crossing& c,
                                       const TileLanes& lanes) {
  const Double4 inv = broadcast<Double4>(c.inv), middle = weights_of(plane, at, c),
                largest = abs(middle) + load<Double4>(plane.half) * broadcast<Double4>(c.size),
                margin = broadcast<Double4>(0x1p-21) * largest + broadcast<Double4>(c.least);
  alignas(16) float w[4], by_x[4], by_y[4];
  store(demoted(middle - margin), w);
  store(demoted(load<Double4>(plane.dx) * inv), by_x), store(demoted(load<Double4>(plane.dy) * inv), by_y);
  const auto weight = [&](int k)
                          HWY_ATTR { return broadcast<Float16>(w[k]) + lanes.linear(by_x[k], by_y[k]); };
  const Float16 zero = broadcast<Float16>(0.0f);
  return bits(le(zero, weight(0)) & le(zero, weight(1)) & le(zero, weight(2)));
}

/// c, ex, ey, sx and sy.
struct QSteps {
  alignas(16) float c[4], ex[4], ey[4];
  float sx, sy;

  SIMD_INLINE QSteps(const RayRows& rows, const SquareEye& eye, const SeenPlane& plane, const TileMiddle& at,
                     const Crossing& crossing, PlaneError& error) {
    const double by_x = plane.dx[3] * crossing.inv, by_y = plane.dy[3] * crossing.inv;
    sx = static_cast<float>(by_x), sy = static_cast<float>(by_y);
    const Double4 along = broadcast<Double4>(crossing.t);
    const Float4 fx = demoted(along * (load<Double4>(rows.dx) - broadcast<Double4>(by_x) * at.d)),
                 fy = demoted(along * (load<Double4>(rows.dy) - broadcast<Double4>(by_y) * at.d));
    store(demoted(load<Double4>(eye.from_base) + along * at.d), c);
    store(fx, ex), store(fy, ey);
    store(max(load<Float4>(error.steps), broadcast<Float4>(1.5f) * (abs(fx) + abs(fy))), error.steps);
    error.off = std::max(error.off, crossing.off);
  }
  SIMD_INLINE Vector16 all(const TileLanes& lanes) const {
    const Float16 one = broadcast<Float16>(1.0f), inverse = one / (one + lanes.linear(sx, sy));
    return {mul_add(lanes.linear(ex[0], ey[0]), inverse, broadcast<Float16>(c[0])),
            mul_add(lanes.linear(ex[1], ey[1]), inverse, broadcast<Float16>(c[1])),
            mul_add(lanes.linear(ex[2], ey[2]), inverse, broadcast<Float16>(c[2]))};
  }
};

}  // namespace tenebra::points::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
