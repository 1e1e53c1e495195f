// Occluders of a group in blocks of sixteen, and the boxes around their shadows on the light's plane as a
// point, or points of a range, see them. Included once per target.
#if defined(TENEBRA_SOFT_OCCLUDER_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_OCCLUDER_BLOCKS_INL_H_
#undef TENEBRA_SOFT_OCCLUDER_BLOCKS_INL_H_
#else
#define TENEBRA_SOFT_OCCLUDER_BLOCKS_INL_H_
#endif

#include <bit>
#include <span>
#include <vector>

#include "soft/occluders/group_candidates.h"
#include "soft/occluders/group_point.h"
#include "soft/polygon/light_polygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// A box around points of a group in the light's axes.
struct PointRange {
  glm::dvec3 low{0.0}, high{0.0};
  glm::dvec2 light_from{0.0};  ///< u and v of the axes' origin from the light's
  double light_height = 0;     ///< of the light's plane over the axes' origin
  double weight = 1;           ///< LightAxes::weight
};
inline const GroupPoint& range_of(const GroupPoint& at) {
  return at;
}

/// Sixteen occluders. Idle lanes hold anything.
struct OccluderBlock {
  double corners[4][3][16];  ///< corner, coordinate, occluder
  double plane[3][16];
  double sign[16];
  std::uint32_t triangle[16], height[16];
  std::uint32_t lanes = 0;       ///< bits of the occluders that are there
  std::uint32_t indefinite = 0;  ///< and of those whose sign depends on the point
  std::uint32_t quads = 0;       ///< and of those with four corners
};

SIMD_INLINE void put(const Candidate& c, OccluderBlock& block, std::size_t lane) {
  for (int k = 0; k < 4; ++k)
    for (int axis = 0; axis < 3; ++axis) block.corners[k][axis][lane] = c.corners[k][axis];
  for (int k = 0; k < 3; ++k) block.plane[k][lane] = c.plane[k];
  block.sign[lane] = c.sign;
  block.triangle[lane] = c.triangle;
  block.height[lane] = c.height;
  block.lanes |= 1u << lane;
  if (c.sign == 0) block.indefinite |= 1u << lane;
  if (c.is_quad) block.quads |= 1u << lane;
}

/// Where the shadows of a block lie on the light's plane. Sides: least u, -greatest u, least v, -greatest v.
template <class T>
struct BlockBoxes {
  T sides[4][16];
  std::uint32_t lanes = 0;     ///< that may shadow something
  std::uint64_t boxes_of = 0;  ///< number of the range that they are for
};

using Wide = Pack<double, 16>;

SIMD_INLINE Wide wide(double value) {
  return broadcast<Wide>(value);
}

/// Widens least_at and most_at by the u (axis 0) or v (1) at which a place between `low` and `high` is seen
/// from points of a range, where the way to the light's plane is t0 to t1 times that to the place. Linear in
/// the point and in t: the extremes are at the ends.
SIMD_INLINE void shadow_range(const PointRange& at, int axis, Wide low, Wide high, Wide t0, Wide t1,
                              Wide& least_at, Wide& most_at) {
  for (const double place : {at.low[axis], at.high[axis]}) {
    const Wide from = wide(at.light_from[axis] + at.weight * place), near = low - wide(place),
               far = high - wide(place);
    least_at = min(least_at, from + min(near * t0, near * t1));
    most_at = max(most_at, from + max(far * t0, far * t1));
  }
}

/// Least and minus greatest values of shadows on an axis, cut off at -2 and 2, to which shadows without
/// bounds reach.
struct ShadowSides {
  Wide low, minus_high;
};
template <class Bounded>
SIMD_INLINE ShadowSides bounded_sides(Bounded bounded, Wide low, Wide high) {
  const Wide two = wide(2), minus = wide(-2);
  return {max(select(bounded, low, minus), minus), wide(0) - min(select(bounded, high, two), two)};
}

/// Those of both axes, as BlockBoxes has them.
template <class T, class Bounded>
SIMD_INLINE void store_sides(Bounded bounded, const Wide (&low)[2], const Wide (&high)[2],
                             T (&sides)[4][16]) {
  for (int axis = 0; axis < 2; ++axis) {
    const ShadowSides side = bounded_sides(bounded, low[axis], high[axis]);
    store_narrowed(side.low, sides[2 * axis]);
    store_narrowed(side.minus_high, sides[2 * axis + 1]);
  }
}

/// Boxes of the shadows on the light's plane that a point sees. An occluder wholly at or below its height
/// shadows nothing; one that is partly so may shadow all.
template <class T>
HWY_NOINLINE void find_boxes(const OccluderBlock& block, const GroupPoint& at, BlockBoxes<T>& out) {
  const Wide far = wide(1e30), zero = wide(0), one = wide(1), reach = wide(at.reach);
  Wide low[2] = {far, far}, high[2] = {zero - far, zero - far}, lowest = far, highest = zero - far;
  for (int k = 0; k < (block.quads == 0 ? 3 : 4); ++k) {
    const auto& corner = block.corners[k];
    const Wide rise = load<Wide>(corner[2]) - wide(at.in_axes.z);
    lowest = min(lowest, rise);
    highest = max(highest, rise);
    const Wide t = reach / select(lt(zero, rise), rise, one);
    for (int axis = 0; axis < 2; ++axis) {
      const Wide seen = wide(at.in_light[axis]) + (load<Wide>(corner[axis]) - wide(at.in_axes[axis])) * t;
      low[axis] = min(low[axis], seen);
      high[axis] = max(high[axis], seen);
    }
  }
  store_sides(lt(zero, lowest), low, high, out.sides);
  out.lanes = block.lanes & lt_bits(zero, highest);
}

/// Boxes of the shadows that points of a range may see. An occluder wholly at or below the lowest point
/// shadows nothing; one that is partly at or below the highest may shadow all.
template <class T>
HWY_NOINLINE void find_boxes(const OccluderBlock& block, const PointRange& at, BlockBoxes<T>& out) {
  const Wide far = wide(1e30), zero = wide(0), one = wide(1);
  Wide low[2] = {far, far}, high[2] = {zero - far, zero - far}, lowest = far, highest = zero - far;
  const Wide reach_up = wide(at.light_height - at.weight * at.low.z),
             reach = wide(at.light_height - at.weight * at.high.z);
  for (int k = 0; k < (block.quads == 0 ? 3 : 4); ++k) {
    const auto& corner = block.corners[k];
    const Wide z = load<Wide>(corner[2]), rise = z - wide(at.high.z), rise_up = z - wide(at.low.z);
    lowest = min(lowest, rise);
    highest = max(highest, rise_up);
    const auto above = lt(zero, rise);
    const Wide t0 = reach / select(above, rise, one), t1 = reach_up / select(above, rise_up, one);
    for (int axis = 0; axis < 2; ++axis) {
      const Wide place = load<Wide>(corner[axis]);
      shadow_range(at, axis, place, place, t0, t1, low[axis], high[axis]);
    }
  }
  store_sides(lt(zero, lowest), low, high, out.sides);
  out.lanes = block.lanes & lt_bits(zero, highest);
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
