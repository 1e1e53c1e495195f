// Lists of boxes on the light's plane, narrowed sixteen at a time to what meets a part of the light. Included
// once per target.
#if defined(TENEBRA_SOFT_SHADOW_LIST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_SHADOW_LIST_INL_H_
#undef TENEBRA_SOFT_SHADOW_LIST_INL_H_
#else
#define TENEBRA_SOFT_SHADOW_LIST_INL_H_
#endif

#include <vector>

#include "soft/polygon/light_fragments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// A part of the light: |u - cu| <= hu, |v - cv| <= hv.
template <class T>
struct LightBox {
  T cu = 0, cv = 0, hu = 1, hv = 1;
};

template <class T>
SIMD_INLINE LightBox<T> box_of(const LightPolygon<T>& polygon) {
  const T low_u = reduce_min(polygon.x), high_u = reduce_max(polygon.x);
  const T low_v = reduce_min(polygon.y), high_v = reduce_max(polygon.y);
  return {(low_u + high_u) / 2, (low_v + high_v) / 2, (high_u - low_u) / 2, (high_v - low_v) / 2};
}

template <class T>
SIMD_INLINE LightBox<T> bounds_of(const LightPolygon<T>& polygon) {
  return box_of(polygon);
}
template <class T>
SIMD_INLINE const LightBox<T>& box_of(const LightBox<T>& box) {
  return box;
}

/// Up to 64 boxes in a row. Sides as in BlockBoxes; whole registers of sixteen can be read.
template <class T>
struct ShadowBoxes {
  const T* sides[4];
  const LaneIndex<T>* ids;

  ShadowBoxes at(std::size_t k) const {
    return {{sides[0] + k, sides[1] + k, sides[2] + k, sides[3] + k}, ids + k};
  }
};

/// Which of the first sixteen boxes meet `box`.
template <class T>
SIMD_INLINE Mask<T, 16> meets(const ShadowBoxes<T>& boxes, const LightBox<T>& box) {
  using Lanes = Pack<T, 16>;
  const auto below = [&](int k, T border) {
    return lt(load<Lanes>(boxes.sides[k]), broadcast<Lanes>(border));
  };
  return below(0, box.cu + box.hu) & below(1, box.hu - box.cu) & below(2, box.cv + box.hv) &
         below(3, box.hv - box.cv);
}

/// Those of the bits of `left` whose boxes meet `box`.
template <class T>
SIMD_INLINE std::uint64_t meeting(const ShadowBoxes<T>& boxes, std::uint64_t left, const LightBox<T>& box) {
  std::uint64_t met = 0;
  for (int k = 0; k < 64 && left >> k != 0; k += 16)
    met |= static_cast<std::uint64_t>(bits(meets(boxes.at(static_cast<std::size_t>(k)), box))) << k;
  return met & left;
}

/// The area that each of the first sixteen has in common with `box`, if they meet.
template <class T>
SIMD_INLINE Pack<T, 16> common_areas(const ShadowBoxes<T>& boxes, const LightBox<T>& box) {
  using Lanes = Pack<T, 16>;
  const auto beyond = [&](int k, T border) {
    return max(load<Lanes>(boxes.sides[k]), broadcast<Lanes>(border));
  };
  return (beyond(0, box.cu - box.hu) + beyond(1, -box.hu - box.cu)) *
         (beyond(2, box.cv - box.hv) + beyond(3, -box.hv - box.cv));
}

/// The place of the box that has most in common with `box`, the first of several, among those of the bits of
/// `left`. Clears the bits of those that do not meet `box`; 64 if none is left.
template <class T>
SIMD_INLINE int widest_of(const ShadowBoxes<T>& boxes, std::uint64_t& left, const LightBox<T>& box) {
  using Lanes = Pack<T, 16>;
  T areas[64];
  Lanes most = broadcast<Lanes>(T(-1));
  std::uint64_t met = 0;
  for (int k = 0; k < 64 && left >> k != 0; k += 16) {
    const ShadowBoxes<T> sixteen = boxes.at(static_cast<std::size_t>(k));
    const auto there =
        mask_of_bits<T, 16>(static_cast<std::uint32_t>(left >> k) & 0xffffu) & meets(sixteen, box);
    const Lanes area = select(there, common_areas(sixteen, box), broadcast<Lanes>(T(-1)));
    store(area, areas + k);
    most = max(most, area);
    met |= static_cast<std::uint64_t>(bits(there)) << k;
  }
  left = met;
  const Lanes widest = broadcast<Lanes>(reduce_max(most));
  std::uint64_t found = 0;
  for (int k = 0; k < 64 && met >> k != 0; k += 16)
    found |= static_cast<std::uint64_t>(bits(eq(load<Lanes>(areas + k), widest))) << k;
  return std::countr_zero(found);
}

/// A stack of lists: [first, count()) is the latest.
template <class T>
class ShadowList {
public:
  using Index = Pack<LaneIndex<T>, 16>;
  using Lanes = Pack<T, 16>;

  std::size_t count() const { return count_; }
  /// Forgets the places beyond.
  void shrink(std::size_t count) { count_ = count; }
  std::size_t id(std::size_t place) const { return static_cast<std::size_t>(ids_[place]); }

  /// Appends those of sixteen boxes in `lanes` that meet `box`. Their ids are first, first + 1 ...
  SIMD_INLINE void append(const T (&sides)[4][16], std::size_t first, std::uint32_t lanes,
                          const LightBox<T>& box) {
    make_room(16);
    append_meeting({{sides[0], sides[1], sides[2], sides[3]}, nullptr},
                   load<Index>(lane_numbers<T>) + broadcast<Index>(static_cast<LaneIndex<T>>(first)),
                   mask_of_bits<T, 16>(lanes), box);
  }

  /// Appends those of the list [first, last) that meet `box`.
  HWY_NOINLINE void narrow(std::size_t first, std::size_t last, const LightBox<T>& box) {
    make_room(last - first);
    for (std::size_t i = first; i < last; i += 16)
      append_meeting(from(i), load<Index>(&ids_[i]), lanes_below<T>(last - i), box);
  }

  /// The places from `first` on, until the list grows.
  SIMD_INLINE ShadowBoxes<T> from(std::size_t first) const {
    return {{&sides_[0][first], &sides_[1][first], &sides_[2][first], &sides_[3][first]}, &ids_[first]};
  }

private:
  /// Room for `more` places and a full register behind them.
  SIMD_INLINE void make_room(std::size_t more) {
    const std::size_t needed = count_ + more + 16;
    if (ids_.size() >= needed) return;
    for (auto& side : sides_) side.resize(2 * needed);
    ids_.resize(2 * needed);
  }

  SIMD_INLINE void append_meeting(const ShadowBoxes<T>& boxes, Index ids, Mask<T, 16> valid,
                                  const LightBox<T>& box) {
    const auto chosen = valid & meets(boxes, box);
    if (!any(chosen)) return;
    std::size_t added = 0;
    for (int k = 0; k < 4; ++k) added = compress(chosen, load<Lanes>(boxes.sides[k]), &sides_[k][count_]);
    compress(chosen, ids, &ids_[count_]);
    count_ += added;
  }

  std::vector<T> sides_[4];
  std::vector<LaneIndex<T>> ids_;
  std::size_t count_ = 0;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
