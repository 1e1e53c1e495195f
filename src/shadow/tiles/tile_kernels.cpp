#include "shadow/tiles/tile_kernels.h"

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/tiles/tile_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/pack-inl.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

namespace {

constexpr float u = 0x1p-24f;

using Double4 = Pack<double, 4>;

void project(const TileRows& rows, const glm::dvec3& origin, std::uint32_t lanes, TilePoints& points) {
  const Pack3<Double4> light = splat3<Double4>(origin.x, origin.y, origin.z);
  const glm::dvec3& other = rows.point(std::countr_zero(lanes));
  Float4 x[4], y[4], z[4];
  for (int row = 0; row < 4; ++row) {
    Pack3<Double4> p = load3<Double4>(&rows[row]->x);
    const std::uint32_t there = (lanes >> (4 * row)) & 15u;
    if (there != 15u) {
      const Truth<double, 4> is_there = truth_of<double, 4>(there);
      p = {choose(is_there, p.x, splat<Double4>(other.x)), choose(is_there, p.y, splat<Double4>(other.y)),
           choose(is_there, p.z, splat<Double4>(other.z))};
    }
    p = p - light;
    x[row] = demoted(p.x), y[row] = demoted(p.y), z[row] = demoted(p.z);
  }
  const Float16 px = joined(x), py = joined(y), pz = joined(z);
  store(px, points.x), store(py, points.y), store(pz, points.z);
  const Float16 size = max(absolute(px), max(absolute(py), absolute(pz)));
  points.nearest = least(size), points.farthest = greatest(size);
}

std::uint32_t beyond_gap(const TilePoints& points, std::uint32_t lanes) {
  const int first = std::countr_zero(lanes);
  const Pack3<Float16> p{load<Float16>(points.x), load<Float16>(points.y), load<Float16>(points.z)};
  const Pack3<Float16> apart = p - splat3<Float16>(points.x[first], points.y[first], points.z[first]);
  const Float16 distance2 = dot(apart, apart);
  const float farthest2 =
      greatest(distance2);  // lanes without a ray are at 0, or lie on another that has one
  if (!(farthest2 > 0)) return 0;
  std::uint32_t nearer[9];
  for (int k = 1; k <= 8; ++k) {
    const float limit = farthest2 * static_cast<float>(k * k) / 64.0f;
    nearer[k] = less_bits(distance2, splat<Float16>(limit)) & lanes;
  }
  for (int k = 1; k <= 4; ++k)
    if (nearer[k] == nearer[k + 4]) return lanes & ~nearer[k];
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
  box.w = least(w) * (1 - 16 * u), box.w1 = greatest(w) * (1 + 16 * u);
  return box.u0 >= -face_limit && box.u1 <= face_limit && box.v0 >= -face_limit && box.v1 <= face_limit;
}

}  // namespace

TileKernels tile_kernels() {
  return {project, beyond_gap, bound};
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
