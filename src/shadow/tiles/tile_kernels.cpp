#include "shadow/tiles/tile_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/tiles/tile_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "shadow/tiles/tile_bounds-inl.h"
#include "simd/dispatch.h"
#include "simd/pack_lanes-inl.h"

#include <algorithm>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

constexpr float u = 0x1p-24f;
constexpr float off_the_face = 1e30f;
// A square is a node as it stands if it is at most this many times as wide as its tiles are on average: 4
// for a flat patch, with room for perspective and curvature.
constexpr float coherent_extent = 8;

// The receivers' slack allows for more than one rounding of to_light.
Facing facing(const points::ReceiverBlock& r, const FacingLight& light) {
  const Float16 scale = broadcast<Float16>(light.scale);
  const Pack3<Float16> to_light{broadcast<Float16>(light.at.x) - load<Float16>(r.ax) * scale,
                                broadcast<Float16>(light.at.y) - load<Float16>(r.ay) * scale,
                                broadcast<Float16>(light.at.z) - load<Float16>(r.az) * scale};
  const Pack3<Float16> n{load<Float16>(r.nx), load<Float16>(r.ny), load<Float16>(r.nz)};
  const Float16 value = dot(n, to_light);
  const Float16 bound = load<Float16>(r.slack) * (abs(to_light.x) + abs(to_light.y) + abs(to_light.z));
  const std::uint32_t before = lt_bits(bound, value),
                      behind = lt_bits(bound, broadcast<Float16>(0.0f) - value);
  return {before, 0xffffu & ~(before | behind)};
}

/// Bounds of a coordinate of the points relative to the light. The base relative to it is rounded by u, as q
/// is and as their sum is: 3u (|base| + grain) and, with the roundings here, 5u.
struct Range {
  Float16 low, high;
};
SIMD_INLINE Range range_of(const points::PointSquare& square, const glm::dvec3& light, int axis) {
  const auto base = static_cast<float>(static_cast<double>(square.base.at[axis]) - light[axis]);
  const Float16 centre = broadcast<Float16>(base),
                margin = broadcast<Float16>(5 * u * ((base < 0 ? -base : base) + square.base.grain));
  return {centre + load<Float16>(square.low[axis]) - margin,
          centre + load<Float16>(square.high[axis]) + margin};
}

// The ranges are true bounds; the quotients are rounded by 2u: 6u of values up to face_limit. The boxes of
// triangles are off by 5u of values up to face_limit: 16u. Together 32u.
bool project(const points::PointSquare& square, std::uint32_t tiles, const glm::dvec3& light, int face,
             RayNode& node, FaceBox& all) {
  const int axis = face / 2;
  const Range across[2] = {range_of(square, light, (axis + 1) % 3), range_of(square, light, (axis + 2) % 3)};
  Range z = range_of(square, light, axis);
  const Float16 zero = broadcast<Float16>(0.0f), one = broadcast<Float16>(1.0f);
  if (face % 2 != 0) z = {zero - z.high, zero - z.low};
  const Float16 near_inverse = one / z.low, far_inverse = one / z.high;
  constexpr float margin = 32 * u;
  const Mask<float, 16> asked = mask_of_bits<float, 16>(tiles);
  const Float16 top = broadcast<Float16>(off_the_face), bottom = zero - top;
  float* const low[2] = {node.u0, node.v0};
  float* const high[2] = {node.u1, node.v1};
  float* const bounds[2][2] = {{&all.u0, &all.u1}, {&all.v0, &all.v1}};
  const float apart = coherent_extent / static_cast<float>(std::popcount(tiles));
  bool fits = (tiles & ~lt_bits(broadcast<Float16>(shortest_ray), z.low)) == 0;
  for (int k = 0; k < 2; ++k) {
    const Range r = across[k];
    const Float16 from =
                      r.low * select_le(zero, r.low, far_inverse, near_inverse) - broadcast<Float16>(margin),
                  to = r.high * select_le(r.high, zero, far_inverse, near_inverse) +
                       broadcast<Float16>(margin);
    store(from, low[k]), store(to, high[k]);
    const float least_of_all = *bounds[k][0] = reduce_min(select(asked, from, top)),
                greatest_of_all = *bounds[k][1] = reduce_max(select(asked, to, bottom));
    fits &= least_of_all >= -face_limit && greatest_of_all <= face_limit &&
            greatest_of_all - least_of_all <= reduce_add(select(asked, to - from, zero)) * apart;
  }
  const Float16 w = far_inverse * broadcast<Float16>(1 - 16 * u),
                w1 = near_inverse * broadcast<Float16>(1 + 16 * u);
  store(w, node.w), store(w1, node.w1);
  all.w = reduce_min(select(asked, w, top)), all.w1 = reduce_max(select(asked, w1, zero));
  return fits;
}

// All ranges are true bounds; what is rounded here is in the margins.
bool project_distant(const points::PointSquare& square, std::uint32_t tiles, const DistantFace& f,
                     RayNode& node, FaceBox& all) {
  const TileRange x = tile_range(square, f, 0), y = tile_range(square, f, 1), z = tile_range(square, f, 2);
  const Nearness n = nearness_of(z.at, f);
  const float sizes[3] = {x.size, y.size, z.size};
  const TileMargins off = tile_margins(sizes, f);
  const Mask<float, 16> asked = mask_of_bits<float, 16>(tiles);
  const Float16 top = broadcast<Float16>(farthest_coordinate),
                bottom = broadcast<Float16>(-farthest_coordinate), zero = broadcast<Float16>(0.0f);
  const float apart = coherent_extent / static_cast<float>(std::popcount(tiles));
  const DistantRange across[2] = {sheared(x.at, z.at, f.s, n), sheared(y.at, z.at, f.t, n)};
  const float margins[2] = {off.u, off.v};
  float* const low[2] = {node.u0, node.v0};
  float* const high[2] = {node.u1, node.v1};
  float* const bounds[2][2] = {{&all.u0, &all.u1}, {&all.v0, &all.v1}};
  bool fits = true;
  for (int k = 0; k < 2; ++k) {
    const Float16 from = across[k].low - broadcast<Float16>(margins[k]),
                  to = across[k].high + broadcast<Float16>(margins[k]);
    store(from, low[k]), store(to, high[k]);
    const float least_of_all = *bounds[k][0] = reduce_min(select(asked, from, top)),
                greatest_of_all = *bounds[k][1] = reduce_max(select(asked, to, bottom));
    fits &= greatest_of_all - least_of_all <= reduce_add(select(asked, to - from, zero)) * apart;
  }
  const Float16 w = z.at.low * n.far_inverse - broadcast<Float16>(off.w),
                w1 = z.at.high * n.near_inverse + broadcast<Float16>(off.w);
  store(w, node.w), store(w1, node.w1);
  all.w = reduce_min(select(asked, w, top)), all.w1 = reduce_max(select(asked, w1, bottom));
  return fits;
}

void bound_distant(const points::PointTile& tile, const points::PointBase& from, std::uint32_t lanes,
                   const DistantFace& f, FaceBox& box) {
  bound(tile, from, lanes, f, box);
}

}  // namespace

TileKernels tile_kernels() {
  return {facing, project, bound, project_distant, bound_distant};
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::shadow {

FacingLight facing_light(const ShadowLight& light) {
  const glm::dvec3 at = light.directional ? light.to_light : light.position;
  const double size = std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
  if (light.directional) return {glm::vec3(at / size), 0.0f};
  // Corners become too small to count beside a light that far away, never too large.
  return size > 0x1p100 ? FacingLight{glm::vec3(at * 0x1p-64), 0x1p-64f} : FacingLight{light.position, 1.0f};
}

TileKernels tile_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, tile_kernels)();
}

}  // namespace tenebra::shadow
#endif
