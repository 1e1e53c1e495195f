// The visible part of the light by subtracting occluders from it: next from each fragment the occluder that
// overlaps it most, so that fragments stay few where most occluders cut it.
//
// Occluders that took light from one point mostly do so from the next: these hot ones are kept apart and come
// first. Only the light that they leave is tested against the others, through the bounds of their blocks: a
// point in full shadow under a thousand leaves never looks at most of them. The same for one point and for a
// packet of them. Included once per target.
#if defined(TENEBRA_SOFT_CLIP_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#undef TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#else
#define TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#endif

#include <algorithm>
#include <type_traits>

#include "simd/prefetch.h"
#include "soft/clip/part_boxes-inl.h"
#include "soft/occluders/block_bounds-inl.h"
#include "soft/occluders/point_occluders-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// For one point (OnePoint) or a packet of them (ManyPoints).
template <class Sight>
class ClipSolver {
  using T = typename Sight::Number;
  using Part = typename Sight::Part;
  using Parts = typename Sight::Parts;
  using Occluders = typename Sight::Occluders;

public:
  /// Takes over the candidates of a group in places `order`, largest first; only some of them if `stop` is
  /// requested.
  void reset(const GroupCandidates& group, std::span<const std::uint32_t> order, const StopFlag* stop) {
    group_ = &group;
    order_ = order;
    hot_.clear(group.heights);
    hot_ids_.clear();
    cold_.clear(group.heights);
    cold_.reserve(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i % look_after == 0) {
        if (stop_requested(stop)) return;
        cold_.make_room(std::min(order.size(), i + look_after));
      }
      if (i + ahead < order.size()) expect(group.all[order[i + ahead]]);
      cold_.add(group.all[order[i]]);
    }
    if (has_many()) bounds_.find(cold_);
  }

  /// The next queries are about `at`, which must stay where it is.
  void move_to(typename Sight::At& at) {
    range_ = range_of(at);
    if (has_many()) {
      choose_hot();
      hot_.move_to(at);
    }
    cold_.move_to(at);
    blocks_listed_ = false;
  }

  /// Appends the parts of `light` (convex, within |u|, |v| <= 1) visible from the point to `out`.
  HWY_NOINLINE void query(const Part& light, Parts& out) {
    if (cold_.block_count() <= 1) return subtract_block(light, out);
    Parts left = take();
    if (hot_.count() == 0) {
      left.push(light);
    } else {
      for (std::size_t b = 0; b < hot_.block_count(); ++b) hot_.append_block(b, box_of(light));
      subtract_listed(hot_, 0, hot_.list.count(), light, left);
      hot_.list.shrink(0);
    }
    if (!left.empty()) subtract_cold(left, out);
    give_back(std::move(left));
  }

private:
  static constexpr std::size_t few = 64;           ///< most occluders that one pass subtracts from a part
  static constexpr std::size_t ahead = 8;          ///< candidates are prefetched this many places ahead
  static constexpr std::size_t look_after = 4096;  ///< candidates between two checks for a stop
  static constexpr std::size_t many = 48;  ///< with more occluders than this it pays to keep a few apart

  /// Prefetches a candidate that will be added soon.
  static SIMD_INLINE void expect(const Candidate& c) {
    simd::prefetch(c.corners[0]);
    simd::prefetch(c.corners[3]);
    simd::prefetch(&c.second);
  }

  bool has_many() const { return cold_.count() > many; }

  /// Where all occluders fit in one block, there is nothing to sort out.
  void subtract_block(const Part& light, Parts& out) {
    if (cold_.block_count() == 0) return out.push(light);
    std::uint64_t met = 0;
    const ShadowBoxes<T> boxes = cold_.first_block(box_of(light), met);
    subtract_few(cold_, boxes, met, light, out);
  }

  /// Adds to the hot ones the occluders that took light from the last point; where far more are hot than took
  /// some, starts again with those that did.
  void choose_hot() {
    useful_.clear();
    for (std::size_t b = 0; b < hot_.block_count(); ++b) {
      for (std::uint32_t bits = hot_.take_useful(b); bits != 0; bits &= bits - 1)
        useful_.push_back(hot_ids_[16 * b + static_cast<std::size_t>(std::countr_zero(bits))]);
    }
    const std::size_t old = useful_.size();
    for (std::size_t b = 0; b < cold_.block_count(); ++b) {
      for (std::uint32_t bits = cold_.take_useful(b); bits != 0; bits &= bits - 1)
        useful_.push_back(static_cast<std::uint32_t>(16 * b) +
                          static_cast<std::uint32_t>(std::countr_zero(bits)));
    }
    if (hot_.count() > 2 * old + 16) {
      for (const std::uint32_t id : hot_ids_) cold_.block(id / 16).lanes |= 1u << (id % 16);
      hot_ids_.clear();
      hot_.clear(group_->heights);
      std::sort(useful_.begin(), useful_.end());
      for (const std::uint32_t id : useful_) add_hot(id);
    } else {
      for (std::size_t i = old; i < useful_.size(); ++i) add_hot(useful_[i]);
    }
  }

  void add_hot(std::uint32_t id) {
    if (hot_.count() == few) return;
    hot_ids_.push_back(id);
    hot_.add(group_->all[order_[id]]);
    cold_.block(id / 16).lanes &= ~(1u << (id % 16));
  }

  /// Subtracts the occluders that are not hot from `parts`.
  void subtract_cold(const Parts& parts, Parts& out) {
    boxes_.reset(parts);
    const LightBox<T> box = boxes_.around(0, parts.size());
    if (!has_many()) {
      for (std::size_t b = 0; b < cold_.block_count(); ++b) cold_.append_block(b, box);
      subtract_list(parts, boxes_, 0, parts.size(), box, 0, out);
      return cold_.list.shrink(0);
    }
    if (!blocks_listed_) {
      bounds_.list_at(range_, blocks_);
      blocks_listed_ = true;
    }
    const std::size_t last = blocks_.count();
    blocks_.narrow(0, last, box);
    subtract_blocks(parts, 0, parts.size(), box, last, blocks_.count(), out);
    blocks_.shrink(last);
  }

  /// Subtracts the blocks in places [first, last) from the parts in places [begin, end) of boxes_, which lie
  /// in `box`. The parts are sorted by halves, as in the building of a tree of boxes, while the box that is
  /// around them meets more than four blocks for each part, and from there on with a list of the blocks'
  /// triangles.
  void subtract_blocks(const Parts& parts, std::size_t begin, std::size_t end, const LightBox<T>& box,
                       std::size_t first, std::size_t last, Parts& out) {
    const std::size_t middle = 4 * (end - begin) < last - first ? boxes_.halve(begin, end, box) : begin;
    if (middle == begin || middle == end) {
      const std::size_t place = cold_.list.count();
      for (std::size_t i = first; i < last; ++i) cold_.append_block(blocks_.id(i), box);
      subtract_list(parts, boxes_, begin, end, box, place, out);
      return cold_.list.shrink(place);
    }
    for (const auto& [from, to] : {std::pair(begin, middle), std::pair(middle, end)}) {
      const LightBox<T> half = boxes_.around(from, to);
      blocks_.narrow(first, last, half);
      subtract_blocks(parts, from, to, half, last, blocks_.count(), out);
      blocks_.shrink(last);
    }
  }

  /// Subtracts the occluders in the list from place `first` on from several parts.
  void subtract_list(const Parts& parts, PartBoxes<T>& boxes, std::size_t begin, std::size_t end,
                     const LightBox<T>& box, std::size_t first, Parts& out) {
    const std::size_t last = cold_.list.count();
    if (last - first <= few) {
      for (std::size_t i = begin; i < end; ++i)
        subtract_in_order(first, last, loaded(parts[boxes.part(i)]), boxes.around(i, i + 1), out);
      return;
    }
    if (end - begin == 1) return subtract_long_list(loaded(parts[boxes.part(begin)]), first, out);
    std::size_t middle = boxes.halve(begin, end, box);
    if (middle == begin || middle == end) middle = begin + (end - begin) / 2;
    for (const auto& [from, to] : {std::pair(begin, middle), std::pair(middle, end)}) {
      const LightBox<T> half = boxes.around(from, to);
      cold_.list.narrow(first, last, half);
      subtract_list(parts, boxes, from, to, half, last, out);
      cold_.list.shrink(last);
    }
  }

  /// Subtracts a few occluders of the list from one part, and the others from the fragments that these leave.
  void subtract_long_list(const Part& part, std::size_t first, Parts& out) {
    Parts left = take();
    subtract_listed(cold_, first, first + few, part, left);
    if (!left.empty()) {
      PartBoxes<T> boxes = take(spare_boxes_);
      boxes.reset(left);
      subtract_list(left, boxes, 0, left.size(), boxes.around(0, left.size()), first + few, out);
      spare_boxes_.push_back(std::move(boxes));
    }
    give_back(std::move(left));
  }

  /// Appends `part` less the occluders in places [first, last), at most `few`.
  void subtract_listed(Occluders& c, std::size_t first, std::size_t last, const Part& part, Parts& out) {
    if (first == last) return out.push(part);
    subtract_few(c, c.list.from(first), lowest_bits(last - first), part, out);
  }

  /// Subtracts those that are not hot from a part in `box`: most are only near it, so none is chosen first.
  HWY_NOINLINE void subtract_in_order(std::size_t first, std::size_t last, const Part& part,
                                      const LightBox<T>& box, Parts& out) {
    if (first == last) return out.push(part);
    const ShadowBoxes<T> boxes = cold_.list.from(first);
    const std::uint64_t met = meeting(boxes, lowest_bits(last - first), box);
    if (met == 0) return out.push(part);
    typename Sight::OwnPart own = part;  // a copy for packets, which take lanes from it
    subtract_next(cold_, boxes, met, std::countr_zero(met), bounds_of(part), own, out);
    subtract_todo(cold_, boxes, out);
  }

  /// count: 1 to 64.
  static std::uint64_t lowest_bits(std::size_t count) { return ~std::uint64_t{0} >> (64 - count); }

  /// Appends `part` less the occluders of the bits of `left`. Each fragment chooses its own next occluder:
  /// the one whose box overlaps its own most takes most away, and leaves the fewest fragments.
  HWY_NOINLINE void subtract_few(Occluders& c, const ShadowBoxes<T>& boxes, std::uint64_t left,
                                 const Part& part, Parts& out) {
    subtract_widest(c, boxes, left, part, out);
    subtract_todo(c, boxes, out);
  }

  /// Fragments that are not finished, each with the occluders of `boxes` that are left for it.
  SIMD_INLINE void subtract_todo(Occluders& c, const ShadowBoxes<T>& boxes, Parts& out) {
    while (!todo_.empty()) {
      const std::uint64_t left = todo_left_.back();
      todo_left_.pop_back();
      subtract_widest(c, boxes, left, todo_.pop(), out);
    }
  }

  /// Subtracts first the occluder that overlaps `part` most, or, where there are so few that any order will
  /// do, that of the first bit of `left`.
  SIMD_INLINE void subtract_widest(Occluders& c, const ShadowBoxes<T>& boxes, std::uint64_t left,
                                   typename Sight::OwnPart part, Parts& out) {
    const bool in_order = std::popcount(left) <= Sight::any_order;
    const auto bounds = in_order ? typename Sight::Bounds{} : bounds_of(part);
    const int k = in_order ? std::countr_zero(left) : widest_of(boxes, left, box_of(bounds));
    subtract_next(c, boxes, left, k, bounds, part, out);
  }

  /// Subtracts occluders of the bits of `left`, first that of bit k, from `part` until one overlaps it; the
  /// others are still to be subtracted from what that one leaves.
  SIMD_INLINE void subtract_next(Occluders& c, const ShadowBoxes<T>& boxes, std::uint64_t left, int k,
                                 const typename Sight::Bounds& bounds,
                                 std::remove_reference_t<typename Sight::OwnPart>& part, Parts& out) {
    for (; left != 0; k = std::countr_zero(left)) {
      left &= ~(std::uint64_t{1} << k);
      const auto id = static_cast<std::size_t>(boxes.ids[k]);
      if (!c.subtract(id, bounds, part, boxes.ids, left, todo_, out)) continue;
      todo_left_.resize(todo_.size(), left);
      c.mark_useful(id);
      if (Sight::takes_all || part.empty()) return;
    }
    out.push(part);
  }

  /// A list with anything in it: a spare one, for its memory, if there is one.
  template <class List>
  static List take(std::vector<List>& spare) {
    if (spare.empty()) return {};
    List list = std::move(spare.back());
    spare.pop_back();
    return list;
  }
  Parts take() {
    Parts list = take(spare_);
    list.clear();
    return list;
  }
  void give_back(Parts list) { spare_.push_back(std::move(list)); }

  const GroupCandidates* group_ = nullptr;
  std::span<const std::uint32_t> order_;
  typename Sight::Range range_;
  Occluders hot_;                                ///< those that took light from the last points
  Occluders cold_;                               ///< all; lanes of the hot ones are idle
  std::vector<std::uint32_t> hot_ids_, useful_;  ///< ids in cold_
  BlockBounds<T> bounds_;                        ///< of cold_
  ShadowList<T> blocks_;
  bool blocks_listed_ = false;
  PartBoxes<T> boxes_;                    ///< of the parts that the hot ones leave
  Parts todo_;                            ///< parts that are still to be subtracted from
  std::vector<std::uint64_t> todo_left_;  ///< for each, the occluders that are left
  std::vector<Parts> spare_;
  std::vector<PartBoxes<T>> spare_boxes_;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
