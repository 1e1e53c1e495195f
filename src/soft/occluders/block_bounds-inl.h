// Bounds of blocks of occluders, and at a point the boxes on the light's plane that hold all shadows of a
// block. Included once per target.
#if defined(TENEBRA_SOFT_BLOCK_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_BLOCK_BOUNDS_INL_H_
#undef TENEBRA_SOFT_BLOCK_BOUNDS_INL_H_
#else
#define TENEBRA_SOFT_BLOCK_BOUNDS_INL_H_
#endif

#include "soft/occluders/occluder_list-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

template <class T>
class BlockBounds {
public:
  void find(auto& candidates) {
    count_ = candidates.block_count();
    bounds_.resize((count_ + 15) / 16);
    for (std::size_t b = 0; b < count_; ++b) {
      const OccluderBlock& block = candidates.block(b);
      const auto there = mask_of_bits<double, 16>(block.lanes);
      for (int axis = 0; axis < 3; ++axis) {
        const Wide v0 = load<Wide>(block.corners[0][axis]), v1 = load<Wide>(block.corners[1][axis]);
        const Wide v2 = load<Wide>(block.corners[2][axis]), v3 = load<Wide>(block.corners[3][axis]);
        const Wide low = min(min(v0, v1), min(v2, v3)), high = max(max(v0, v1), max(v2, v3));
        bounds_[b / 16].low[axis][b % 16] = reduce_min(select(there, low, wide(1e300)));
        bounds_[b / 16].high[axis][b % 16] = reduce_max(select(there, high, wide(-1e300)));
      }
    }
  }

  /// Fills `list`, from its beginning on, with the blocks that may shadow a part of the light.
  HWY_NOINLINE void list_at(const auto& at, ShadowList<T>& list) const {
    list.shrink(0);
    for (std::size_t from = 0; from < count_; from += 16) {
      T sides[4][16];
      const std::uint32_t above = find_boxes_of(bounds_[from / 16], at, sides);
      const std::uint32_t there = count_ - from < 16 ? (1u << (count_ - from)) - 1u : 0xffffu;
      list.append(sides, from, above & there, LightBox<T>());
    }
  }

private:
  struct Bounds {
    double low[3][16], high[3][16];  ///< in the light's axes
  };

  /// A box with a part at or below the height of a point may shadow all.
  static SIMD_INLINE std::uint32_t find_boxes_of(const Bounds& bounds, const GroupPoint& at,
                                                 T (&sides)[4][16]) {
    const Wide zero = wide(0), one = wide(1), reach = wide(at.reach);
    const Wide lowest = load<Wide>(bounds.low[2]) - wide(at.in_axes.z);
    const Wide highest = load<Wide>(bounds.high[2]) - wide(at.in_axes.z);
    const auto boxed = lt(zero, lowest);
    const Wide near = reach / select(boxed, lowest, one), far = reach / select(boxed, highest, one);
    Wide low[2], high[2];
    for (int axis = 0; axis < 2; ++axis) {
      const Wide from = wide(at.in_light[axis]), place = wide(at.in_axes[axis]);
      const Wide first = load<Wide>(bounds.low[axis]) - place, last = load<Wide>(bounds.high[axis]) - place;
      low[axis] = from + min(first * near, first * far);
      high[axis] = from + max(last * near, last * far);
    }
    store_sides(boxed, low, high, sides);
    return lt_bits(zero, highest);
  }
  static SIMD_INLINE std::uint32_t find_boxes_of(const Bounds& bounds, const PointRange& at,
                                                 T (&sides)[4][16]) {
    const Wide zero = wide(0), one = wide(1), far = wide(1e30);
    const Wide bottom = load<Wide>(bounds.low[2]), top = load<Wide>(bounds.high[2]);
    const auto boxed = lt(zero, bottom - wide(at.high.z));
    Wide t0 = far, t1 = zero;
    for (const double z : {at.low.z, at.high.z}) {
      const Wide reach = wide(at.light_height - at.weight * z);
      const Wide near = reach / select(boxed, bottom - wide(z), one);
      const Wide beyond = reach / select(boxed, top - wide(z), one);
      t0 = min(t0, min(near, beyond));
      t1 = max(t1, max(near, beyond));
    }
    Wide low[2] = {far, far}, high[2] = {zero - far, zero - far};
    for (int axis = 0; axis < 2; ++axis)
      shadow_range(at, axis, load<Wide>(bounds.low[axis]), load<Wide>(bounds.high[axis]), t0, t1, low[axis],
                   high[axis]);
    store_sides(boxed, low, high, sides);
    return lt_bits(zero, top - wide(at.low.z));
  }

  std::vector<Bounds> bounds_;
  std::size_t count_ = 0;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
