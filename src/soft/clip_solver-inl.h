// The visible part of the light by subtracting occluders from it, largest first; where many reach the light
// it is halved, like a kd-tree, until few are left in a part.
//
// What took light from one point mostly does so from the next: those occluders are kept apart and come first.
// Only what they leave of the light meets the others, found through the bounds of their blocks: a point in
// full shadow under a thousand leaves never looks at most of them. Included once per target.
#if defined(TENEBRA_SOFT_CLIP_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#undef TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#else
#define TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#endif

#include <algorithm>

#include "soft/block_bounds-inl.h"
#include "soft/light_fragments-inl.h"
#include "soft/part_boxes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

template <class T>
class ClipSolver {
public:
  /// Takes over the candidates of a group in places `order`, largest first.
  void reset(const GroupCandidates& group, std::span<const std::uint32_t> order) {
    group_ = &group;
    order_ = order;
    hot_.clear(group.heights);
    hot_ids_.clear();
    cold_.clear(group.heights);
    for (const std::uint32_t place : order) cold_.add(group.all[place]);
    if (has_many()) bounds_.find(cold_);
  }

  /// The next queries are about this point.
  void move_to(const GroupPoint& at) {
    at_ = at;
    if (has_many()) {
      choose_hot();
      hot_.move_to(at_);
    }
    cold_.move_to(at_);
    blocks_listed_ = false;
  }

  /// Appends the parts of `light` (convex, within |u|, |v| <= 1) visible from the point to `out`.
  HWY_NOINLINE void query(const LightPolygon<T>& light, FragmentList<T>& out) {
    if (cold_.block_count() <= 1) return subtract_block(light, out);
    FragmentList<T> left = take();
    if (hot_.count() == 0) {
      left.push(light);
    } else {
      for (std::size_t b = 0; b < hot_.block_count(); ++b) hot_.append_block(b, box_of(light));
      solve(hot_, light, 0, left);
      hot_.list.shrink(0);
    }
    if (!left.empty()) subtract_cold(left, out);
    give_back(std::move(left));
  }

private:
  using Candidates = ClipCandidates<T>;
  static constexpr std::size_t few = 24;      ///< occluders that are subtracted without more ado
  static constexpr std::size_t handful = 32;  ///< occluders that are looked at for each part anew
  static constexpr std::size_t largest = 8;   ///< occluders that go first where halving does not part them
  static constexpr std::size_t many = 48;     ///< occluders from which on it pays to keep some apart

  bool has_many() const { return cold_.count() > many; }

  /// Where all occluders fit in one block, there is nothing to sort out.
  void subtract_block(const LightPolygon<T>& light, FragmentList<T>& out) {
    const std::size_t from = out.size();
    out.push(light);
    std::uint32_t met = cold_.block_count() == 0 ? 0 : cold_.meeting(0, box_of(light));
    for (; met != 0 && out.size() > from; met &= met - 1)
      subtract_one(cold_.lines_of(static_cast<std::size_t>(std::countr_zero(met))), out, from);
  }

  /// Puts those aside that took light from the last point; sorts out the others where they are more.
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
    hot_ids_.push_back(id);
    hot_.add(group_->all[order_[id]]);
    cold_.block(id / 16).lanes &= ~(1u << (id % 16));
  }

  /// What the occluders that are not hot leave of `parts`.
  void subtract_cold(const FragmentList<T>& parts, FragmentList<T>& out) {
    boxes_.reset(parts);
    const LightBox<T> box = boxes_.around(0, parts.size());
    if (!has_many()) {
      for (std::size_t b = 0; b < cold_.block_count(); ++b) cold_.append_block(b, box);
      subtract_list(parts, 0, parts.size(), box, 0, out);
      return cold_.list.shrink(0);
    }
    if (!blocks_listed_) {
      bounds_.list_at(at_, blocks_);
      blocks_listed_ = true;
    }
    const std::size_t last = blocks_.count();
    subtract_blocks(parts, 0, parts.size(), box, 0, last, out);
  }

  /// Subtracts the blocks in places [first, last) from the parts in places [begin, end) of boxes_, which lie
  /// in `box`. The parts are sorted by halves, as in the building of a tree of boxes, until they are few for
  /// the blocks around them, and from there on with a list of the blocks' triangles.
  void subtract_blocks(const FragmentList<T>& parts, std::size_t begin, std::size_t end,
                       const LightBox<T>& box, std::size_t first, std::size_t last, FragmentList<T>& out) {
    const std::size_t middle = 16 * (end - begin) < last - first ? boxes_.halve(begin, end, box) : begin;
    if (middle == begin || middle == end) {
      const std::size_t place = cold_.list.count();
      for (std::size_t i = first; i < last; ++i) cold_.append_block(blocks_.id(i), box);
      subtract_list(parts, begin, end, box, place, out);
      return cold_.list.shrink(place);
    }
    for (const auto& [from, to] : {std::pair(begin, middle), std::pair(middle, end)}) {
      const LightBox<T> half = boxes_.around(from, to);
      blocks_.narrow(first, last, half);
      subtract_blocks(parts, from, to, half, last, blocks_.count(), out);
      blocks_.shrink(last);
    }
  }

  /// The same for the occluders in the list from place `first` on.
  void subtract_list(const FragmentList<T>& parts, std::size_t begin, std::size_t end, const LightBox<T>& box,
                     std::size_t first, FragmentList<T>& out) {
    const std::size_t last = cold_.list.count();
    if (last - first <= handful) {
      for (std::size_t i = begin; i < end; ++i) subtract_handful(parts, i, first, last, out);
      return;
    }
    if (end - begin == 1) return solve(cold_, loaded(parts[boxes_.part(begin)]), first, out);
    std::size_t middle = boxes_.halve(begin, end, box);
    if (middle == begin || middle == end) middle = begin + (end - begin) / 2;
    for (const auto& [from, to] : {std::pair(begin, middle), std::pair(middle, end)}) {
      const LightBox<T> half = boxes_.around(from, to);
      cold_.list.narrow(first, last, half);
      subtract_list(parts, from, to, half, last, out);
      cold_.list.shrink(last);
    }
  }

  /// Subtracts the occluders in the list [first, last), at most a handful, from one part.
  HWY_INLINE void subtract_handful(const FragmentList<T>& parts, std::size_t place, std::size_t first,
                                   std::size_t last, FragmentList<T>& out) {
    const std::size_t from = out.size();
    out.push(loaded(parts[boxes_.part(place)]));
    if (first == last) return;
    std::uint64_t met = cold_.list.meeting(first, last, boxes_.around(place, place + 1));
    for (; met != 0 && out.size() > from; met &= met - 1) {
      const std::size_t id = cold_.list.id(first + static_cast<std::size_t>(std::countr_zero(met)));
      if (subtract_one(cold_.lines_of(id), out, from)) cold_.mark_useful(id);
    }
  }

  /// Subtracts the occluders in the list from place `first` on from `part`.
  void solve(Candidates& c, const LightPolygon<T>& part, std::size_t first, FragmentList<T>& out) {
    const std::size_t last = c.list.count();
    if (last - first <= few) return subtract_all(c, part, first, last, out);
    if (halve_light(c, part, first, last, out)) return;
    FragmentList<T> left = take();
    subtract_all(c, part, first, first + largest, left);
    for (std::size_t k = 0; k < left.size(); ++k) {
      const LightPolygon<T> fragment = loaded(left[k]);
      const std::size_t from = c.list.count();
      if (c.find_among(first + largest, last, box_of(fragment))) solve(c, fragment, from, out);
      c.list.shrink(from);
    }
    give_back(std::move(left));
  }

  /// Solves both halves of `part` if that parts the occluders: three quarters of them in only one half, at
  /// least.
  bool halve_light(Candidates& c, const LightPolygon<T>& part, std::size_t first, std::size_t last,
                   FragmentList<T>& out) {
    const LightBox<T> box = box_of(part);
    if (HWY_MAX(box.hu, box.hv) < 4 * on_line<T>) return false;  // no line parts its vertices
    const bool wide = box.hu >= box.hv;
    LightBox<T> low = box;
    (wide ? low.hu : low.hv) *= T(0.5);
    LightBox<T> high = low;
    (wide ? low.cu : low.cv) -= wide ? low.hu : low.hv;
    (wide ? high.cu : high.cv) += wide ? low.hu : low.hv;
    const bool low_lit = c.find_among(first, last, low);
    const std::size_t middle = c.list.count();
    const bool high_lit = c.find_among(first, last, high);
    const std::size_t count = c.list.count() - last;
    const bool parted = !low_lit || !high_lit || 4 * count < 5 * (last - first);
    if (parted) {
      const T sign = -1;
      const LightLine<T> below = wide ? LightLine<T>{sign, 0, box.cu} : LightLine<T>{0, sign, box.cv};
      const LightLine<T> above = wide ? LightLine<T>{1, 0, -box.cu} : LightLine<T>{0, 1, -box.cv};
      LightPolygon<T> kept = part;
      if (high_lit && keep_side(above, kept)) solve(c, kept, middle, out);
      c.list.shrink(middle);
      kept = part;
      if (low_lit && keep_side(below, kept)) solve(c, kept, last, out);
    }
    c.list.shrink(last);
    return parted;
  }

  /// Cuts `polygon` to the line's positive side; false if nothing is left.
  static HWY_NOINLINE bool keep_side(const LightLine<T>& line, LightPolygon<T>& polygon) {
    const LineValues<T> values = evaluate(polygon, line);
    if (values.positive == 0) return false;
    if (values.negative == 0) return true;
    LightPolygon<T> inside, outside;
    split(polygon, values, inside, outside);
    polygon = inside;
    return true;
  }

  /// Appends what the occluders in places [first, last) leave of `part`.
  HWY_NOINLINE void subtract_all(Candidates& c, const LightPolygon<T>& part, std::size_t first,
                                 std::size_t last, FragmentList<T>& out) {
    const std::size_t from = out.size();
    out.push(part);
    for (std::size_t i = first; i < last && out.size() > from; ++i) {
      if (subtract_one(c.lines_of(c.list.id(i)), out, from)) c.mark_useful(c.list.id(i));
    }
  }

  /// Subtracts a shadow from the fragments from place `from` on; true if that took something.
  static HWY_INLINE bool subtract_one(const ShadowLines<T>& lines, FragmentList<T>& fragments,
                                      std::size_t from) {
    bool taken = false;
    std::size_t end = fragments.size();  // of those not yet subtracted from: what is left goes behind them
    for (std::size_t k = from; k < end;) {
      const LightPolygon<T> fragment = loaded(fragments[k]);
      const LineSides sides = sides_of(fragment, lines);
      if (sides.positive != all_lines || !subtract(fragment, lines, sides.negative, fragments)) {
        ++k;
        continue;
      }
      taken = true;
      fragments.remove(k, end--);
    }
    return taken;
  }

  FragmentList<T> take() {
    if (spare_.empty()) return {};
    FragmentList<T> list = std::move(spare_.back());
    spare_.pop_back();
    list.clear();
    return list;
  }
  void give_back(FragmentList<T> list) { spare_.push_back(std::move(list)); }

  const GroupCandidates* group_ = nullptr;
  std::span<const std::uint32_t> order_;
  GroupPoint at_;
  Candidates hot_;                               ///< what took light from the last points
  Candidates cold_;                              ///< all; lanes of the hot ones are idle
  std::vector<std::uint32_t> hot_ids_, useful_;  ///< ids in cold_
  BlockBounds<T> bounds_;                        ///< of cold_
  ShadowList<T> blocks_;
  bool blocks_listed_ = false;
  PartBoxes<T> boxes_;  ///< of what the hot ones leave
  std::vector<FragmentList<T>> spare_;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
