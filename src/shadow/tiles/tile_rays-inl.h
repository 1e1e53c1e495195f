// The rays of a tile, from the visible points in double. Included once per target.
#if defined(TENEBRA_TILE_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_TILE_RAYS_INL_H_
#undef TENEBRA_TILE_RAYS_INL_H_
#else
#define TENEBRA_TILE_RAYS_INL_H_
#endif

#include <bit>
#include <cmath>

#include "shadow/tiles/tile_kernels.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// Fills `out` for the lanes in `lanes` (not 0).
HWY_INLINE void load_tile_rays(const TileRows& rows, const glm::dvec3& origin, std::uint32_t lanes,
                               TileRays& out) {
  using Double4 = Pack<double, 4>;
  const glm::dvec3& first = rows.point(std::countr_zero(lanes));
  const glm::dvec3& last = rows.point(31 - std::countl_zero(lanes));
  const glm::dvec3 base = 0.5 * (first - origin) + 0.5 * (last - origin);
  const Pack3<Double4> light = splat3<Double4>(origin.x, origin.y, origin.z);
  const Pack3<Double4> centre = splat3<Double4>(base.x, base.y, base.z);
  const Double4 zero = splat<Double4>(0.0);
  Float4 x[4], y[4], z[4];
  for (int row = 0; row < 4; ++row) {
    Pack3<Double4> q = load3<Double4>(&rows[row]->x) - light - centre;
    const std::uint32_t there = (lanes >> (4 * row)) & 15u;
    if (there != 15u) {
      const Truth<double, 4> is_there = truth_of<double, 4>(there);
      q = {choose(is_there, q.x, zero), choose(is_there, q.y, zero), choose(is_there, q.z, zero)};
    }
    x[row] = demoted(q.x), y[row] = demoted(q.y), z[row] = demoted(q.z);
  }
  const Pack3<Float16> q{joined(x), joined(y), joined(z)};
  store(q.x, out.qx), store(q.y, out.qy), store(q.z, out.qz);
  out.base[0] = base.x, out.base[1] = base.y, out.base[2] = base.z;
  // q is rounded by u, the sum of squares by 4u: 2^-20 covers both many times over. Where squares leave the
  // range of floats, by coordinates.
  const float largest2 = greatest(dot(q, q));
  if (largest2 > 1e-30f && largest2 < 1e36f) {
    out.radius = std::sqrt(largest2) * (1 + 0x1p-20f);
  } else {
    const float largest = greatest(max(absolute(q.x), max(absolute(q.y), absolute(q.z))));
    out.radius = largest * 1.7320509f * (1 + 0x1p-20f) + 0x1p-126f;
  }
  const double distance = std::sqrt(base.x * base.x + base.y * base.y + base.z * base.z);
  out.reach = static_cast<float>((distance + static_cast<double>(out.radius)) * (1 + 0x1p-20));
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
