// Lists of boxes on the light's plane, narrowed sixteen at a time to what meets a part of the light. Included
// once per target.
#if defined(TENEBRA_SOFT_SHADOW_LIST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_SHADOW_LIST_INL_H_
#undef TENEBRA_SOFT_SHADOW_LIST_INL_H_
#else
#define TENEBRA_SOFT_SHADOW_LIST_INL_H_
#endif

#include <vector>

#include "soft/light_fragments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// A part of the light: |u - cu| <= hu, |v - cv| <= hv.
template <class T>
struct LightBox {
  T cu = 0, cv = 0, hu = 1, hv = 1;
};

template <class T>
HWY_INLINE LightBox<T> box_of(const LightPolygon<T>& polygon) {
  const T low_u = least(polygon.x), high_u = greatest(polygon.x);
  const T low_v = least(polygon.y), high_v = greatest(polygon.y);
  return {(low_u + high_u) / 2, (low_v + high_v) / 2, (high_u - low_u) / 2, (high_v - low_v) / 2};
}

/// A stack of lists: [first, count()) is the latest. Sides of boxes as in BlockAtPoint.
template <class T>
class ShadowList {
public:
  using Index = Pack<LaneIndex<T>, 16>;
  using Lanes = Pack<T, 16>;

  /// Of sixteen boxes those that meet `box`.
  static HWY_INLINE Truth<T, 16> meets(const T* const (&sides)[4], const LightBox<T>& box) {
    const auto below = [&](int k, T border) { return less(load<Lanes>(sides[k]), splat<Lanes>(border)); };
    return below(0, box.cu + box.hu) & below(1, box.hu - box.cu) & below(2, box.cv + box.hv) &
           below(3, box.hv - box.cv);
  }

  std::size_t count() const { return count_; }
  /// Forgets the places beyond.
  void shrink(std::size_t count) { count_ = count; }
  std::size_t id(std::size_t place) const { return static_cast<std::size_t>(ids_[place]); }

  /// Appends those of 16 boxes in `lanes` that meet `box`. Their ids are first, first + 1 ...
  HWY_INLINE void append(const T (&sides)[4][16], std::size_t first, std::uint32_t lanes,
                         const LightBox<T>& box) {
    make_room(16);
    const T* from[4] = {sides[0], sides[1], sides[2], sides[3]};
    append_meeting(from, load<Index>(lane_numbers<T>) + splat<Index>(static_cast<LaneIndex<T>>(first)),
                   truth_of<T, 16>(lanes), box);
  }

  /// Appends those of the list [first, last) that meet `box`.
  HWY_NOINLINE void narrow(std::size_t first, std::size_t last, const LightBox<T>& box) {
    make_room(last - first);
    for (std::size_t i = first; i < last; i += 16) {
      const T* sides[4] = {&sides_[0][i], &sides_[1][i], &sides_[2][i], &sides_[3][i]};
      append_meeting(sides, load<Index>(&ids_[i]), lanes_below<T>(last - i), box);
    }
  }

  /// Bits of those of the list [first, last), at most 64, that meet `box`.
  HWY_INLINE std::uint64_t meeting(std::size_t first, std::size_t last, const LightBox<T>& box) const {
    std::uint64_t met = 0;
    for (std::size_t i = first; i < last; i += 16) {
      const T* sides[4] = {&sides_[0][i], &sides_[1][i], &sides_[2][i], &sides_[3][i]};
      const std::uint32_t there = last - i < 16 ? (1u << (last - i)) - 1u : 0xffffu;
      met |= static_cast<std::uint64_t>(bits(meets(sides, box)) & there) << (i - first);
    }
    return met;
  }

private:
  /// Room for `more` places and a full register behind them.
  HWY_INLINE void make_room(std::size_t more) {
    const std::size_t needed = count_ + more + 16;
    if (ids_.size() >= needed) return;
    for (auto& side : sides_) side.resize(2 * needed);
    ids_.resize(2 * needed);
  }

  HWY_INLINE void append_meeting(const T* const (&sides)[4], Index ids, Truth<T, 16> valid,
                                 const LightBox<T>& box) {
    const auto chosen = valid & meets(sides, box);
    if (!any(chosen)) return;
    std::size_t added = 0;
    for (int k = 0; k < 4; ++k) added = compress(chosen, load<Lanes>(sides[k]), &sides_[k][count_]);
    compress(chosen, ids, &ids_[count_]);
    count_ += added;
  }

  std::vector<T> sides_[4];
  std::vector<LaneIndex<T>> ids_;
  std::size_t count_ = 0;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
