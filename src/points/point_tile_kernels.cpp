#include "points/point_tile_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "points/point_tile_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/demote16-inl.h"
#include "simd/dispatch.h"
#include "simd/double8-inl.h"
#include "simd/pack_lanes-inl.h"

#include <bit>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::points::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using Double4 = Pack<double, 4>;
using Vector16 = Pack3<Float16>;

Vector16 points_of(const PointTile& tile) {
  return {load<Float16>(tile.qx), load<Float16>(tile.qy), load<Float16>(tile.qz)};
}

// q is rounded by u, the sum of squares by 4u: 2^-20 covers both many times over. Where squares leave the
// range of floats, by coordinates.
float radius_of(const Vector16& q) {
  const float largest2 = reduce_max(dot(q, q));
  if (largest2 > 1e-30f && largest2 < 1e36f) return std::sqrt(largest2) * (1 + 0x1p-20f);
  const float largest = reduce_max(max(abs(q.x), max(abs(q.y), abs(q.z))));
  return largest * 1.7320509f * (1 + 0x1p-20f) + 0x1p-126f;
}

/// What eight lanes see.
struct Receivers8 {
  Vector8 normal, a, du, dv;
};

SIMD_INLINE Receivers8 alike(const Receiver& r) {
  return {broadcast8(r.normal), broadcast8(r.a), broadcast8(r.du), broadcast8(r.dv)};
}

SIMD_INLINE Receivers8 each(const Receiver* const* of) {
  alignas(64) double v[4][3][8];
  for (int i = 0; i < 8; ++i) {
    const Receiver& r = *of[i];
    const glm::dvec3* const from[4] = {&r.normal, &r.a, &r.du, &r.dv};
    for (int k = 0; k < 4; ++k) v[k][0][i] = from[k]->x, v[k][1][i] = from[k]->y, v[k][2][i] = from[k]->z;
  }
  const auto vector = [&](int k) HWY_ATTR {
    return Vector8{load<Double8>(v[k][0]), load<Double8>(v[k][1]), load<Double8>(v[k][2])};
  };
  return {vector(0), vector(1), vector(2), vector(3)};
}

/// Points of eight lanes, and the bits of those that lie inside of their triangles.
struct Seen8 {
  Vector8 p;
  std::uint32_t inside;
};

/// Two rows of a tile, from pixel `at` on.
SIMD_INLINE Seen8 see_eight(const Receivers8& r, const PixelRays& rays, glm::uvec2 at) {
  alignas(64) static constexpr double column[8] = {0.5, 1.5, 2.5, 3.5, 0.5, 1.5, 2.5, 3.5},
                                      row[8] = {0.5, 0.5, 0.5, 0.5, 1.5, 1.5, 1.5, 1.5};
  const Double8 px = load<Double8>(column) + broadcast8(static_cast<double>(at.x)),
                py = load<Double8>(row) + broadcast8(static_cast<double>(at.y));
  const Vector8 across = px * broadcast8(rays.dx) + py * broadcast8(rays.dy);
  const Vector8 eye = broadcast8(rays.eye), d0 = broadcast8(rays.d0);
  const Vector8 origin = rays.orthographic ? eye + across : eye,
                direction = rays.orthographic ? d0 : d0 + across;
  const Double8 t = dot_unfused(r.normal, r.a - origin) / dot_unfused(r.normal, direction);
  const Vector8 p = origin + t * direction, from = p - r.a;
  const Double8 u = dot_unfused(r.du, from), v = dot_unfused(r.dv, from);
  const Double8 zero = broadcast<Double8>(0.0), one = broadcast<Double8>(1.0);
  return {p, bits(lt(zero, t) & lt(t, broadcast<Double8>(std::numeric_limits<double>::infinity())) &
                  le(zero, u) & le(zero, v) & le(u + v, one))};
}

SIMD_INLINE std::uint32_t see_eight(const Receivers8& r, const PixelRays& rays, glm::uvec2 at, double* x,
                                    double* y, double* z) {
  const Seen8 seen = see_eight(r, rays, at);
  store(seen.p.x, x), store(seen.p.y, y), store(seen.p.z, z);
  return seen.inside;
}

std::uint32_t see_one(const Receiver& receiver, const PixelRays& rays, glm::uvec2 at, TilePoints& out) {
  if (receiver.flat) return 0;
  const Receivers8 r = alike(receiver);
  const std::uint32_t upper = see_eight(r, rays, at, out.x, out.y, out.z);
  return upper | see_eight(r, rays, at + glm::uvec2(0, 2), out.x + 8, out.y + 8, out.z + 8) << 8;
}

std::uint32_t see_several(const Receiver* const of[tile_points], const PixelRays& rays, glm::uvec2 at,
                          TilePoints& out) {
  std::uint32_t flat = 0;
  for (int i = 0; i < tile_points; ++i) flat |= of[i]->flat ? 1u << i : 0u;
  const std::uint32_t upper = see_eight(each(of), rays, at, out.x, out.y, out.z),
                      lower = see_eight(each(of + 8), rays, at + glm::uvec2(0, 2), out.x + 8, out.y + 8,
                                        out.z + 8);
  return (upper | lower << 8) & ~flat;
}

void take(const glm::dvec3* first, std::size_t width, TilePoints& out) {
  for (int row = 0; row < tile_side; ++row, first += width) {
    const Pack3<Double4> p = load3<Double4>(&first->x);
    const int lane = tile_side * row;
    store(p.x, out.x + lane), store(p.y, out.y + lane), store(p.z, out.z + lane);
  }
}

float fill(const TilePoints& points, const glm::vec3& base, std::uint32_t lanes, PointTile& tile) {
  const Pack3<Double4> centre = broadcast3<Double4>(static_cast<double>(base.x), static_cast<double>(base.y),
                                                    static_cast<double>(base.z));
  const glm::dvec3 other = points.at(std::countr_zero(lanes));
  Float4 x[4], y[4], z[4];
  for (int row = 0; row < 4; ++row) {
    const int first = tile_side * row;
    Pack3<Double4> p{load<Double4>(points.x + first), load<Double4>(points.y + first),
                     load<Double4>(points.z + first)};
    const std::uint32_t there = (lanes >> first) & 15u;
    if (there != 15u) {
      const Mask<double, 4> is_there = mask_of_bits<double, 4>(there);
      p = {select(is_there, p.x, broadcast<Double4>(other.x)),
           select(is_there, p.y, broadcast<Double4>(other.y)),
           select(is_there, p.z, broadcast<Double4>(other.z))};
    }
    p = p - centre;
    x[row] = demoted(p.x), y[row] = demoted(p.y), z[row] = demoted(p.z);
  }
  const Vector16 q{combine(x), combine(y), combine(z)};
  store(q.x, tile.qx), store(q.y, tile.qy), store(q.z, tile.qz);
  return radius_of(q);
}

std::uint32_t beyond_gap(const PointTile& tile, std::uint32_t lanes) {
  const int first = std::countr_zero(lanes);
  const Vector16 apart =
      points_of(tile) - broadcast3<Float16>(tile.qx[first], tile.qy[first], tile.qz[first]);
  const Float16 distance2 =
      select(mask_of_bits<float, 16>(lanes), dot(apart, apart), broadcast<Float16>(0.0f));
  const float farthest2 = reduce_max(distance2);
  if (!(farthest2 > 0)) return 0;
  std::uint32_t nearer[9];
  for (int k = 1; k <= 8; ++k) {
    const float limit = farthest2 * static_cast<float>(k * k) / 64.0f;
    nearer[k] = lt_bits(distance2, broadcast<Float16>(limit)) & lanes;
  }
  for (int k = 1; k <= 4; ++k)
    if (nearer[k] == nearer[k + 4]) return lanes & ~nearer[k];
  return 0;
}

SIMD_INLINE void set_bounds(const Vector16& q, int place, PointSquare& square) {
  const Float16* const axes[3] = {&q.x, &q.y, &q.z};
  for (int axis = 0; axis < 3; ++axis) {
    square.low[axis][place] = reduce_min(*axes[axis]);
    square.high[axis][place] = reduce_max(*axes[axis]);
  }
}

void bound(const PointTile& tile, std::uint32_t lanes, int place, PointSquare& square) {
  const float* const q[3] = {tile.qx, tile.qy, tile.qz};
  const Mask<float, 16> there = mask_of_bits<float, 16>(lanes);
  const int first = std::countr_zero(lanes);
  const auto all = [&](int axis) HWY_ATTR {
    return select(there, load<Float16>(q[axis]), broadcast<Float16>(q[axis][first]));
  };
  set_bounds({all(0), all(1), all(2)}, place, square);
}

float see_whole(const Receiver& receiver, const PixelRays& rays, glm::uvec2 at, const glm::vec3& base,
                PointTile& tile, int place, PointSquare& square) {
  if (receiver.flat) return -1;
  const Receivers8 r = alike(receiver);
  const Seen8 upper = see_eight(r, rays, at), lower = see_eight(r, rays, at + glm::uvec2(0, 2));
  if ((upper.inside & lower.inside) != 0xffu) return -1;
  const Vector8 centre = broadcast8(glm::dvec3(base));
  const Vector8 high = upper.p - centre, low = lower.p - centre;
  const Vector16 q{demoted(high.x, low.x), demoted(high.y, low.y), demoted(high.z, low.z)};
  store(q.x, tile.qx), store(q.y, tile.qy), store(q.z, tile.qz);
  set_bounds(q, place, square);
  return radius_of(q);
}

}  // namespace

PointTileKernels point_tile_kernels() {
  return {see_whole, see_one, see_several, take, fill, beyond_gap, bound};
}

}  // namespace tenebra::points::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::points {

PointTileKernels point_tile_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, point_tile_kernels)();
}

}  // namespace tenebra::points
#endif
