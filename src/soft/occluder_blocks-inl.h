// Occluders of a group in blocks of sixteen, largest first, and at one point, block by block as they are
// asked for: the boxes of their shadows on the light's plane and their lines there. Included once per target.
#if defined(TENEBRA_SOFT_OCCLUDER_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_OCCLUDER_BLOCKS_INL_H_
#undef TENEBRA_SOFT_OCCLUDER_BLOCKS_INL_H_
#else
#define TENEBRA_SOFT_OCCLUDER_BLOCKS_INL_H_
#endif

#include <bit>
#include <span>
#include <vector>

#include "soft/group_candidates.h"
#include "soft/light_polygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// A point as a group knows it.
struct GroupPoint {
  glm::dvec3 from_centre{0.0};  ///< world space
  glm::dvec3 in_axes{0.0};      ///< the same in the light's axes
  glm::dvec2 in_light{0.0};     ///< u and v from the light's origin
  double reach = 0;             ///< height of the light's plane over the point, units of the light
  double turn = 1;              ///< of the axes
  std::uint32_t receiver = no_triangle;
  double receiver_tau = 0;
};

inline GroupPoint group_point(const LightAxes& axes, const glm::dvec3& position, std::uint32_t receiver,
                              double receiver_tau) {
  GroupPoint at{position - axes.centre, {}, {}, 0, axes.turn, receiver, receiver_tau};
  at.in_axes = axes.of(at.from_centre);
  at.in_light = glm::dvec2(axes.centre_uv) + glm::dvec2(at.in_axes);
  at.reach = axes.centre_uv.z - at.in_axes.z;
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

HWY_INLINE void put(const Candidate& c, OccluderBlock& block, std::size_t lane) {
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

/// A block at a point. Sides of boxes: least u, -greatest u, least v, -greatest v.
template <class T>
struct BlockAtPoint {
  T box[4][16];
  T u[16][4], v[16][4], w[16][4];            ///< occluder, line: the edges and the plane, if it needs one
  double sign[16];                           ///< 0: blocks nothing at this point
  std::uint32_t lanes = 0;                   ///< that may shadow something
  std::uint32_t boxes_of = 0, lines_of = 0;  ///< number of the point that they are for
};

using Wide = Pack<double, 16>;

HWY_INLINE Wide wide(double value) {
  return splat<Wide>(value);
}

/// Boxes of the shadows on the light's plane. An occluder all at or below the point's height shadows nothing;
/// one that is partly so may shadow all.
template <class T>
HWY_NOINLINE void find_boxes(const OccluderBlock& block, std::span<const PlaneHeight> heights,
                             const GroupPoint& at, BlockAtPoint<T>& out) {
  const Wide far = wide(1e30), zero = wide(0);
  Wide low_u = far, low_v = far, high_u = wide(-1e30), high_v = high_u, lowest = far, highest = high_u;
  const Wide pu = wide(at.in_light.x), pv = wide(at.in_light.y), reach = wide(at.reach);
  const Wide x = wide(at.in_axes.x), y = wide(at.in_axes.y), z = wide(at.in_axes.z);
  for (int k = 0; k < (block.quads == 0 ? 3 : 4); ++k) {
    const auto& corner = block.corners[k];
    const Wide rise = load<Wide>(corner[2]) - z;
    lowest = min(lowest, rise);
    highest = max(highest, rise);
    const Wide t = reach / choose(less(zero, rise), rise, wide(1));
    const Wide u = pu + (load<Wide>(corner[0]) - x) * t, v = pv + (load<Wide>(corner[1]) - y) * t;
    low_u = min(low_u, u);
    high_u = max(high_u, u);
    low_v = min(low_v, v);
    high_v = max(high_v, v);
  }
  const auto boxed = less(zero, lowest);
  const Wide two = wide(2), minus = wide(-2);
  store_narrowed(max(choose(boxed, low_u, minus), minus), out.box[0]);
  store_narrowed(zero - min(choose(boxed, high_u, two), two), out.box[1]);
  store_narrowed(max(choose(boxed, low_v, minus), minus), out.box[2]);
  store_narrowed(zero - min(choose(boxed, high_v, two), two), out.box[3]);
  out.lanes = block.lanes & less_bits(zero, highest);
  if ((block.indefinite & out.lanes) == 0) return;
  for (int k = 0; k < 16; ++k) {
    out.sign[k] = block.sign[k];
    if (((block.indefinite & out.lanes) >> k & 1u) == 0) continue;
    const bool itself = block.triangle[k] == at.receiver;
    const PlaneHeight& plane = heights[block.height[k]];
    out.sign[k] = itself ? 0 : at.turn * blocking_sign(plane, at.from_centre, at.receiver_tau);
    if (out.sign[k] == 0) out.lanes &= ~(1u << k);
  }
}

/// The lines of occluders first to first + 7 of a block.
template <class T>
HWY_INLINE void find_eight_lines(const OccluderBlock& block, const double* signs, const GroupPoint& at,
                                 std::size_t first, BlockAtPoint<T>& out) {
  using Doubles = Pack<double, 8>;
  using Lanes = Pack<T, 8>;
  const auto num = [](double value) { return splat<Doubles>(value); };
  const auto corner = [&](int k) {
    const auto of = [&](int axis) {
      return load<Doubles>(block.corners[k][axis] + first) - num(at.in_axes[axis]);
    };
    return Pack3<Doubles>{of(0), of(1), of(2)};
  };
  const Doubles sign = load<Doubles>(signs + first);
  Lanes u[4], v[4], w[4];
  Pack3<Doubles> from = corner(0);
  for (int k = 0; k < 4; ++k) {  // of triangles, corner 3 is corner 0, and the fourth line is none
    const Pack3<Doubles> to = corner(k < 3 ? k + 1 : 0);
    const Pack3<Doubles> n = cross(from, to - from);
    u[k] = narrowed<T>(n.x * sign);
    v[k] = narrowed<T>(n.y * sign);
    w[k] = narrowed<T>((n.z * num(at.reach) - n.x * num(at.in_light.x) - n.y * num(at.in_light.y)) * sign);
    from = to;
  }
  const auto quads = truth_of<T, 8>(block.quads >> first);
  const auto plane = [&](int k) { return narrowed<T>(load<Doubles>(block.plane[k] + first) * sign); };
  u[3] = choose(quads, u[3], plane(0));
  v[3] = choose(quads, v[3], plane(1));
  w[3] = choose(quads, w[3], plane(2));
  store_fours(u[0], u[1], u[2], u[3], out.u[first]);
  store_fours(v[0], v[1], v[2], v[3], out.v[first]);
  store_fours(w[0], w[1], w[2], w[3], out.w[first]);
}

/// The lines of a block whose boxes are there.
template <class T>
HWY_NOINLINE void find_lines(const OccluderBlock& block, const GroupPoint& at, BlockAtPoint<T>& out) {
  const double* const signs = (block.indefinite & out.lanes) == 0 ? block.sign : out.sign;
  find_eight_lines(block, signs, at, 0, out);
  find_eight_lines(block, signs, at, 8, out);
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
