#include "shadow/tiles/tile_kernels.h"

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/tiles/tile_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/pack-inl.h"

#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

namespace {

constexpr float u = 0x1p-24f;

using Double4 = Pack<double, 4>;

bool load_tile(const glm::dvec3* const rows[4], const glm::dvec3& origin, std::uint32_t lanes, RayTile& tile,
               TilePoints& points) {
  const int first = std::countr_zero(lanes), last = 31 - std::countl_zero(lanes);
  const glm::dvec3 base =
      0.5 * (rows[first / 4][first % 4] - origin) + 0.5 * (rows[last / 4][last % 4] - origin);
  const Pack3<Double4> light = splat3<Double4>(origin.x, origin.y, origin.z);
  const Pack3<Double4> centre = splat3<Double4>(base.x, base.y, base.z);
  for (int row = 0; row < 4; ++row) {
    Pack3<Double4> p = load3<Double4>(&rows[row]->x) - light;
    const std::uint32_t there = (lanes >> (4 * row)) & 15u;
    if (there != 15u) {
      const Truth<double, 4> is_there = truth_of<double, 4>(there);
      p = {choose(is_there, p.x, centre.x), choose(is_there, p.y, centre.y), choose(is_there, p.z, centre.z)};
    }
    const Pack3<Double4> q = p - centre;
    store_narrowed(p.x, points.x + 4 * row);
    store_narrowed(p.y, points.y + 4 * row);
    store_narrowed(p.z, points.z + 4 * row);
    store_narrowed(q.x, tile.qx + 4 * row);
    store_narrowed(q.y, tile.qy + 4 * row);
    store_narrowed(q.z, tile.qz + 4 * row);
  }
  tile.base[0] = base.x, tile.base[1] = base.y, tile.base[2] = base.z;
  // q is rounded by u, the sum of squares by 4u: 2^-20 covers both many times over. In units of the largest
  // coordinate, so that squares stay in range.
  const Pack3<Float16> q{load<Float16>(tile.qx), load<Float16>(tile.qy), load<Float16>(tile.qz)};
  const float largest = greatest(max(absolute(q.x), max(absolute(q.y), absolute(q.z))));
  tile.radius = largest * 1.7320509f * (1 + 0x1p-20f) + 0x1p-126f;
  if (largest > 1e-18f && largest < 1e18f) tile.radius = std::sqrt(greatest(dot(q, q))) * (1 + 0x1p-20f);
  const double distance = std::sqrt(base.x * base.x + base.y * base.y + base.z * base.z);
  tile.reach = static_cast<float>((distance + static_cast<double>(tile.radius)) * (1 + 0x1p-20));
  tile.live = tile.rays = lanes;
  const Float16 size = max(absolute(load<Float16>(points.x)),
                           max(absolute(load<Float16>(points.y)), absolute(load<Float16>(points.z))));
  return !(least(size) > 0);
}

std::uint32_t beyond_gap(const RayTile& tile) {
  const int first = std::countr_zero(tile.rays);
  const Pack3<Float16> q{load<Float16>(tile.qx), load<Float16>(tile.qy), load<Float16>(tile.qz)};
  const Pack3<Float16> apart = q - splat3<Float16>(tile.qx[first], tile.qy[first], tile.qz[first]);
  const Float16 distance2 = dot(apart, apart);
  float lanes2[16];
  store(distance2, lanes2);
  float farthest2 = 0;
  for (std::uint32_t left = tile.rays; left != 0; left &= left - 1)
    farthest2 = HWY_MAX(farthest2, lanes2[std::countr_zero(left)]);
  if (!(farthest2 > 0)) return 0;
  std::uint32_t nearer[9];
  for (int k = 1; k <= 8; ++k) {
    const float limit = farthest2 * static_cast<float>(k * k) / 64.0f;
    nearer[k] = less_bits(distance2, splat<Float16>(limit)) & tile.rays;
  }
  for (int k = 1; k <= 4; ++k)
    if (nearer[k] == nearer[k + 4]) return tile.rays & ~nearer[k];
  return 0;
}

// The points are rounded by u, the quotient by 3u in all: 3.1 u face_limit and more. The boxes of triangles
// are off by 5u of values up to face_limit: 16u. Together 32u.
bool bound(const TilePoints& points, int face, FaceBox& box) {
  const float* const axes[3] = {points.x, points.y, points.z};
  const int axis = face / 2;
  const Float16 sign = splat<Float16>(face % 2 == 0 ? 1.0f : -1.0f);
  const Float16 z = load<Float16>(axes[axis]) * sign;
  const Float16 w = splat<Float16>(1.0f) / z;
  const Float16 pu = load<Float16>(axes[(axis + 1) % 3]) * w, pv = load<Float16>(axes[(axis + 2) % 3]) * w;
  if (!(least(z) > 0)) return false;
  constexpr float margin = 32 * u;
  box.u0 = least(pu) - margin, box.u1 = greatest(pu) + margin;
  box.v0 = least(pv) - margin, box.v1 = greatest(pv) + margin;
  box.w = least(w) * (1 - 16 * u);
  return box.u0 >= -face_limit && box.u1 <= face_limit && box.v0 >= -face_limit && box.v1 <= face_limit;
}

}  // namespace

TileKernels tile_kernels() {
  return {load_tile, beyond_gap, bound};
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra {

TileKernels tile_kernels(SimdLevel level) {
  switch (level == SimdLevel::automatic ? best_simd_level() : level) {
#if HWY_TARGETS & HWY_AVX3
    case SimdLevel::avx512:
      return N_AVX3::tile_kernels();
#endif
#if HWY_TARGETS & HWY_AVX2
    case SimdLevel::avx2:
      return N_AVX2::tile_kernels();
#endif
#if HWY_TARGETS & HWY_SSE4
    case SimdLevel::sse4:
      return N_SSE4::tile_kernels();
#endif
    default:
      return HWY_STATIC_DISPATCH(tile_kernels)();
  }
}

}  // namespace tenebra
#endif
