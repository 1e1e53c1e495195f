// Occluders as one point sees them, and their subtraction from fragments of the light. Included once per
// target.
#if defined(TENEBRA_SOFT_POINT_OCCLUDERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_POINT_OCCLUDERS_INL_H_
#undef TENEBRA_SOFT_POINT_OCCLUDERS_INL_H_
#else
#define TENEBRA_SOFT_POINT_OCCLUDERS_INL_H_
#endif

#include "simd/double8-inl.h"
#include "soft/occluders/occluder_list-inl.h"
#include "soft/polygon/light_fragments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// The lines of a block's shadows: the edges and the plane, if it needs one.
template <class T>
struct BlockLines {
  T u[16][4], v[16][4], w[16][4];  ///< occluder, line
  std::uint64_t lines_of = 0;      ///< number of the range that they are for
};

/// What the lines of an occluder without a certain sign are multiplied by at a point: 1 or -1, by the side
/// that blocks it, or 0.
inline double sign_at(std::uint32_t triangle, const PlaneHeight& plane, const GroupPoint& at) {
  return triangle == at.receiver ? 0 : at.turn * blocking_sign(plane, at.from_centre, at.receiver_tau);
}

/// The lines of occluders first to first + 7 of a block.
template <class T>
SIMD_INLINE void find_eight_lines(const OccluderBlock& block, const double* signs, const GroupPoint& at,
                                  std::size_t first, BlockLines<T>& out) {
  using Doubles = Pack<double, 8>;
  using Lanes = Pack<T, 8>;
  const auto corner = [&](int k) {
    const auto of = [&](int axis) {
      return load<Doubles>(block.corners[k][axis] + first) - broadcast8(at.in_axes[axis]);
    };
    return Pack3<Doubles>{of(0), of(1), of(2)};
  };
  const Doubles sign = load<Doubles>(signs + first);
  Lanes u[4], v[4], w[4];
  Pack3<Doubles> from = corner(0);
  for (int k = 0; k < 4; ++k) {  // a triangle has corner 0 for corner 3, and no fourth edge
    const Pack3<Doubles> to = corner(k < 3 ? k + 1 : 0);
    const Pack3<Doubles> n = cross(from, to - from);
    u[k] = narrowed<T>(n.x * sign);
    v[k] = narrowed<T>(n.y * sign);
    w[k] = narrowed<T>(
        (n.z * broadcast8(at.reach) - n.x * broadcast8(at.in_light.x) - n.y * broadcast8(at.in_light.y)) *
        sign);
    from = to;
  }
  const auto quads = mask_of_bits<T, 8>(block.quads >> first);
  const auto plane = [&](int k) { return narrowed<T>(load<Doubles>(block.plane[k] + first) * sign); };
  u[3] = select(quads, u[3], plane(0));
  v[3] = select(quads, v[3], plane(1));
  w[3] = select(quads, w[3], plane(2));
  store_fours(u[0], u[1], u[2], u[3], out.u[first]);
  store_fours(v[0], v[1], v[2], v[3], out.v[first]);
  store_fours(w[0], w[1], w[2], w[3], out.w[first]);
}

template <class T>
HWY_NOINLINE void find_lines(const OccluderBlock& block, std::span<const PlaneHeight> heights,
                             const GroupPoint& at, BlockLines<T>& out) {
  double signs[16];
  for (std::uint32_t k = 0; k < 16; ++k) {
    const bool certain = (block.indefinite >> k & 1u) == 0;
    signs[k] = certain ? block.sign[k] : sign_at(block.triangle[k], heights[block.height[k]], at);
  }
  find_eight_lines(block, signs, at, 0, out);
  find_eight_lines(block, signs, at, 8, out);
}

template <class T>
class PointOccluders : public OccluderList<T, GroupPoint> {
public:
  /// `at` must stay where it is until the next call.
  void move_to(const GroupPoint& at) {
    at_ = &at;
    lines_.resize(HWY_MAX(lines_.size(), this->block_count()));
    OccluderList<T, GroupPoint>::move_to(at);
  }

  /// Subtracts an occluder from `part`: false if it does not overlap it. What is left goes to `out`, or to
  /// `rest` if others of `ids` are still to be subtracted from it: those of the bits of `left`. Where these
  /// are few, the bits of those that only lie near the part are cleared.
  SIMD_INLINE bool subtract(std::size_t id, const LightBox<T>&, const LightPolygon<T>& part,
                            const LaneIndex<T>* ids, std::uint64_t& left, FragmentList<T>& rest,
                            FragmentList<T>& out) {
    const ShadowLines<T> lines = lines_of(id);
    const LineSides<T> sides = sides_of(part, lines);
    if (sides.positive != all_lines) return false;
    if (std::popcount(left) <= few_left) left = touching(ids, left, part);
    return subtract_shadow(part, lines, sides, left == 0 ? out : rest);
  }

private:
  /// Up to this many, each is tested once against a part, and not against all of its fragments (measured).
  static constexpr int few_left = 12;

  /// The bits of `left` whose occluders are not separated from `part` by one of their own lines.
  SIMD_INLINE std::uint64_t touching(const LaneIndex<T>* ids, std::uint64_t left,
                                     const LightPolygon<T>& part) {
    std::uint64_t found = 0;
    for (; left != 0; left &= left - 1) {
      const int k = std::countr_zero(left);
      const LineSides<T> sides = sides_of(part, lines_of(static_cast<std::size_t>(ids[k])));
      found |= static_cast<std::uint64_t>(sides.positive == all_lines) << k;
    }
    return found;
  }

  SIMD_INLINE ShadowLines<T> lines_of(std::size_t id) {
    const std::size_t b = id / 16, k = id % 16;
    BlockLines<T>& there = lines_[b];
    if (there.lines_of != this->number()) {
      find_lines(this->block(b), this->heights(), *at_, there);
      there.lines_of = this->number();
    }
    return {there.u[k], there.v[k], there.w[k]};
  }

  std::vector<BlockLines<T>> lines_;
  const GroupPoint* at_ = nullptr;
};

/// The light as one point sees it, for ClipSolver.
template <class T>
struct OnePoint {
  using Number = T;
  using At = const GroupPoint;
  using Range = GroupPoint;
  using Part = LightPolygon<T>;
  using OwnPart = const Part&;
  using Bounds = LightBox<T>;
  using Parts = FragmentList<T>;
  using Occluders = PointOccluders<T>;
  static constexpr bool takes_all = true;  ///< subtract() takes the whole part, and lists get what it leaves
  static constexpr int any_order = 4;      ///< most occluders whose order does not matter
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
