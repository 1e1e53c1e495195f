// Bounds of a tile's rays on a face, from the points themselves. Included once per target.
#if defined(TENEBRA_TILE_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_TILE_BOUNDS_INL_H_
#undef TENEBRA_TILE_BOUNDS_INL_H_
#else
#define TENEBRA_TILE_BOUNDS_INL_H_
#endif

#include <bit>

#include "shadow/tiles/distant_tests-inl.h"
#include "shadow/tiles/tile_kernels.h"
#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Box on a face of some lanes (not 0) of a tile, widened; false if a point is off the face. The base
/// relative to the light is rounded by u, as q is and as their sum is: 3u (|base| + grain), 5u with the
/// roundings here; so the quotient is off by (margin + face_limit margin of z) / z, by 6u for its own
/// roundings and by 16u for those of the boxes of triangles.
SIMD_INLINE bool bound(const points::PointTile& tile, const points::PointBase& from, std::uint32_t lanes,
                       const glm::dvec3& light, int face, FaceBox& box) {
  constexpr float u = 0x1p-24f;
  const float* const q[3] = {tile.qx, tile.qy, tile.qz};
  const Mask<float, 16> there = mask_of_bits<float, 16>(lanes);
  const int first = std::countr_zero(lanes);
  float margins[3];
  Float16 p[3];
  for (int k = 0; k < 3; ++k) {
    const int axis = (face / 2 + 1 + k) % 3;
    const auto base = static_cast<float>(static_cast<double>(from.at[axis]) - light[axis]);
    margins[k] = 5 * u * ((base < 0 ? -base : base) + from.grain);
    p[k] =
        broadcast<Float16>(base) + select(there, load<Float16>(q[axis]), broadcast<Float16>(q[axis][first]));
  }
  if (face % 2 != 0) p[2] = broadcast<Float16>(0.0f) - p[2];
  const float nearest = reduce_min(p[2]) - margins[2], farthest = reduce_max(p[2]) + margins[2];
  if (!(nearest > shortest_ray)) return false;
  const Float16 w = broadcast<Float16>(1.0f) / p[2], pu = p[0] * w, pv = p[1] * w;
  const float near_inverse = 1 / nearest, off = (1 + 16 * u) * near_inverse;
  const float u_margin = (margins[0] + 3.1f * margins[2]) * off + 32 * u,
              v_margin = (margins[1] + 3.1f * margins[2]) * off + 32 * u;
  box = {reduce_min(pu) - u_margin, reduce_max(pu) + u_margin, reduce_min(pv) - v_margin,
         reduce_max(pv) + v_margin, (1 - 16 * u) / farthest,   near_inverse * (1 + 16 * u)};
  return box.u0 >= -face_limit && box.u1 <= face_limit && box.v0 >= -face_limit && box.v1 <= face_limit;
}

/// The box of a tile's lanes on the distant face, which holds all points. Their coordinates are off by 3u
/// (|base| + grain).
SIMD_INLINE void bound(const points::PointTile& tile, const points::PointBase& from, std::uint32_t lanes,
                       const DistantFace& f, FaceBox& box) {
  const float* const q[3] = {tile.qx, tile.qy, tile.qz};
  const Mask<float, 16> there = mask_of_bits<float, 16>(lanes);
  const int first = std::countr_zero(lanes);
  float size[3];
  Float16 p[3];
  for (int k = 0; k < 3; ++k) {
    const int axis = f.axes[k];
    const auto base =
        static_cast<float>(static_cast<double>(from.at[axis]) - static_cast<double>(f.origin[axis]));
    size[k] = std::abs(base) + from.grain;
    p[k] =
        broadcast<Float16>(base) + select(there, load<Float16>(q[axis]), broadcast<Float16>(q[axis][first]));
  }
  const Float16 z = p[2] * broadcast<Float16>(f.sign), one = broadcast<Float16>(1.0f);
  const Float16 inverse = one / (one - broadcast<Float16>(f.k) * z);
  const Float16 pu = (p[0] - broadcast<Float16>(f.s) * z) * inverse,
                pv = (p[1] - broadcast<Float16>(f.t) * z) * inverse, w = z * inverse;
  const TileMargins off = tile_margins(size, f);
  box = {reduce_min(pu) - off.u, reduce_max(pu) + off.u, reduce_min(pv) - off.v,
         reduce_max(pv) + off.v, reduce_min(w) - off.w,  reduce_max(w) + off.w};
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
