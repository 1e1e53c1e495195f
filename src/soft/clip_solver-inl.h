// The visible part of the light by subtracting occluders from it, largest first; where many reach the light
// it is halved, like a kd-tree, until few are left in a part. Included once per target.
#if defined(TENEBRA_SOFT_CLIP_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#undef TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#else
#define TENEBRA_SOFT_CLIP_SOLVER_INL_H_
#endif

#include "soft/clip_candidates-inl.h"
#include "soft/light_fragments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

template <class T>
class ClipSolver {
public:
  void reset(const GroupOccluders& group, Chosen chosen) { candidates_.reset(group, chosen); }

  /// The next queries are about this point.
  void move_to(const GroupPoint& at) { candidates_.move_to(at); }

  /// Appends the parts of `light` (convex, within |u|, |v| <= 1) visible from the point to `out`.
  HWY_NOINLINE void query(const LightPolygon<T>& light, FragmentList<T>& out) { solve(light, 0, out); }

private:
  static constexpr std::size_t few = 24;     ///< occluders that are subtracted without more ado
  static constexpr std::size_t largest = 8;  ///< occluders that go first where halving does not part them

  /// Subtracts the occluders in places from `first` on from `part`.
  void solve(const LightPolygon<T>& part, std::size_t first, FragmentList<T>& out) {
    const std::size_t last = candidates_.count();
    if (last - first <= few) {
      FragmentList<T> left = subtract_all(part, first, last);
      for (std::size_t k = 0; k < left.size(); ++k) out.push(loaded(left[k]));
      return give_back(std::move(left));
    }
    if (halve_light(part, first, last, out)) return;
    FragmentList<T> left = subtract_all(part, first, first + largest);
    for (std::size_t k = 0; k < left.size(); ++k) {
      const LightPolygon<T> fragment = loaded(left[k]);
      const std::size_t from = candidates_.count();
      candidates_.find_among(first + largest, last, box_of(fragment));
      solve(fragment, from, out);
      candidates_.shrink(from);
    }
    give_back(std::move(left));
  }

  /// Solves both halves of `part` if that parts the occluders: three quarters of them in only one half, at
  /// least.
  bool halve_light(const LightPolygon<T>& part, std::size_t first, std::size_t last, FragmentList<T>& out) {
    const LightBox<T> box = box_of(part);
    const bool wide = box.hu >= box.hv;
    LightBox<T> low = box;
    (wide ? low.hu : low.hv) *= T(0.5);
    LightBox<T> high = low;
    (wide ? low.cu : low.cv) -= wide ? low.hu : low.hv;
    (wide ? high.cu : high.cv) += wide ? low.hu : low.hv;
    candidates_.find_among(first, last, low);
    const std::size_t middle = candidates_.count();
    candidates_.find_among(first, last, high);
    const std::size_t count = candidates_.count() - last;
    const bool parted = 4 * count < 5 * (last - first);
    if (parted) {
      const T sign = -1;
      const LightLine<T> below = wide ? LightLine<T>{sign, 0, box.cu} : LightLine<T>{0, sign, box.cv};
      const LightLine<T> above = wide ? LightLine<T>{1, 0, -box.cu} : LightLine<T>{0, 1, -box.cv};
      LightPolygon<T> kept = part;
      if (keep_side(above, kept)) solve(kept, middle, out);
      candidates_.shrink(middle);
      kept = part;
      if (keep_side(below, kept)) solve(kept, last, out);
    }
    candidates_.shrink(last);
    return parted;
  }

  static HWY_INLINE LightBox<T> box_of(const LightPolygon<T>& polygon) {
    const T low_u = least(polygon.x), high_u = greatest(polygon.x);
    const T low_v = least(polygon.y), high_v = greatest(polygon.y);
    return {(low_u + high_u) / 2, (low_v + high_v) / 2, (high_u - low_u) / 2, (high_v - low_v) / 2};
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

  /// What the occluders in places [first, last) leave of `part`.
  HWY_NOINLINE FragmentList<T> subtract_all(const LightPolygon<T>& part, std::size_t first,
                                            std::size_t last) {
    FragmentList<T> now = take();
    now.push(part);
    for (std::size_t i = first; i < last && !now.empty(); ++i) {
      LightLine<T> lines[4];
      const int count = candidates_.lines_of(i, lines);
      next_.clear();
      for (std::size_t k = 0; k < now.size(); ++k) subtract(loaded(now[k]), lines, count, next_);
      now.swap(next_);
    }
    return now;
  }

  FragmentList<T> take() {
    if (spare_.empty()) return {};
    FragmentList<T> list = std::move(spare_.back());
    spare_.pop_back();
    list.clear();
    return list;
  }
  void give_back(FragmentList<T> list) { spare_.push_back(std::move(list)); }

  ClipCandidates<T> candidates_;
  FragmentList<T> next_;
  std::vector<FragmentList<T>> spare_;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
