#include "points/point_tile_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "points/point_tile_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tenebra::points::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;
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

float fill(const TileRows& rows, const glm::vec3& base, std::uint32_t lanes, PointTile& tile) {
  const Pack3<Double4> centre = broadcast3<Double4>(static_cast<double>(base.x), static_cast<double>(base.y),
                                                    static_cast<double>(base.z));
  const glm::dvec3& other = rows.point(std::countr_zero(lanes));
  Float4 x[4], y[4], z[4];
  for (int row = 0; row < 4; ++row) {
    Pack3<Double4> p = load3<Double4>(&rows[row]->x);
    const std::uint32_t there = (lanes >> (4 * row)) & 15u;
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

void bound(const PointTile& tile, std::uint32_t lanes, int place, PointSquare& square) {
  const float* const q[3] = {tile.qx, tile.qy, tile.qz};
  const Mask<float, 16> there = mask_of_bits<float, 16>(lanes);
  const int first = std::countr_zero(lanes);
  for (int axis = 0; axis < 3; ++axis) {
    const Float16 all = select(there, load<Float16>(q[axis]), broadcast<Float16>(q[axis][first]));
    square.low[axis][place] = reduce_min(all);
    square.high[axis][place] = reduce_max(all);
  }
}

}  // namespace

PointTileKernels point_tile_kernels() {
  return {fill, beyond_gap, bound};
}

}  // namespace tenebra::points::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::points {

PointTileKernels point_tile_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, point_tile_kernels)();
}

TileRows::TileRows(const glm::dvec3* first, glm::uvec2 size, glm::uvec2 at) {
  const bool inside = at.x + tile_side <= size.x && at.y + tile_side <= size.y;
  for (std::uint32_t row = 0; row < tile_side; ++row) {
    const glm::dvec3* const from = first + std::size_t{row} * size.x + at.x;
    rows_[row] = inside ? from : copies_[row];
    for (std::uint32_t column = 0; !inside && column < tile_side; ++column)
      copies_[row][column] = at.x + column < size.x && at.y + row < size.y ? from[column] : glm::dvec3(0.0);
  }
}

}  // namespace tenebra::points
#endif
