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
  HWY_NOINLINE void query(const LightPolygon<T>& light, FragmentList<T>& out) {
    list_.clear();
    const LightBox<T> whole;
    if (candidates_.find_all(whole, list_)) return;
    solve(light, whole, 0, 0, out);
  }

private:
  static constexpr std::size_t few = 16;  ///< occluders that are subtracted without more ado
  static constexpr int deepest = 16;      ///< halvings of the light

  /// Subtracts list_[first..] from `part`, the light within `box`.
  void solve(const LightPolygon<T>& part, const LightBox<T>& box, std::size_t first, int depth,
             FragmentList<T>& out) {
    const std::size_t last = list_.size();
    if (last - first <= few || depth == deepest) return subtract_all(part, first, last, out);
    const bool wide = box.hu >= box.hv;
    for (const T side : {T(-1), T(1)}) {
      LightBox<T> half = box;
      (wide ? half.hu : half.hv) *= T(0.5);
      (wide ? half.cu : half.cv) += side * (wide ? half.hu : half.hv);
      const LightLine<T> border =
          wide ? LightLine<T>{side, T(0), -side * box.cu} : LightLine<T>{T(0), side, -side * box.cv};
      LightPolygon<T> kept = part;
      if (!keep_side(border, kept)) continue;
      if (!candidates_.find_among(first, last, half, list_)) solve(kept, half, last, depth + 1, out);
      list_.resize(last);
    }
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

  void subtract_all(const LightPolygon<T>& part, std::size_t first, std::size_t last, FragmentList<T>& out) {
    now_.clear();
    now_.push(part);
    for (std::size_t i = first; i < last && !now_.empty(); ++i) {
      LightLine<T> lines[4];
      const int count = candidates_.lines_of(list_[i], lines);
      next_.clear();
      for (std::size_t k = 0; k < now_.size(); ++k) subtract(loaded(now_[k]), lines, count, next_);
      now_.swap(next_);
    }
    for (std::size_t k = 0; k < now_.size(); ++k) out.push(loaded(now_[k]));
  }

  ClipCandidates<T> candidates_;
  std::vector<std::uint32_t> list_;
  FragmentList<T> now_, next_;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
