// Points by the paper's BSP of line classes, and by clipping the occluders that have no certain side, or all
// of them if the tree grows too large. Included once per target.
#if defined(TENEBRA_SOFT_BSP_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_BSP_SOLVER_INL_H_
#undef TENEBRA_SOFT_BSP_SOLVER_INL_H_
#else
#define TENEBRA_SOFT_BSP_SOLVER_INL_H_
#endif

#include <algorithm>
#include <utility>

#include "soft/bsp/line_class_query-inl.h"
#include "soft/clip/clip_solver-inl.h"
#include "soft/solve/point_sight-inl.h"
#include "soft/solve/solvers.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

template <class T>
class BspSolver final : public Solver {
public:
  void begin(const SoftFrame& frame, const PreparedGroup& group) override {
    receiver_.forget();
    is_counted_ = false;
    set_up_occluders(frame.light, frame.triangles, group.frame, group.candidates, occluders_);
    start_tree(frame, group);
    clip_what_the_tree_leaves(frame, group);
  }

  void solve(const SoftFrame& frame, const PreparedGroup& group, std::span<const std::uint32_t> pixels,
             PixelWriter& writer) override {
    if (!use_tree_) change_solver(writer);
    for (const std::uint32_t pixel : pixels) {
      if (stop_requested(frame.stop)) break;
      solve_point(frame, group, pixel, writer);
      if (!frame.config.keep_trees) start_anew(frame, group, writer);
    }
    finish_whole(frame, whole_, writer);
    if (use_tree_) note_tree(writer.stats());
  }

private:
  void start_tree(const SoftFrame& frame, const PreparedGroup& group) {
    use_tree_ = bsp_.reset(occluders_, frame.triangles, group.frame, frame.config.choice, group.tree_bytes);
  }
  /// From here on points are clipped; the group is counted once.
  void change_solver(PixelWriter& writer) {
    writer.answer_by(SoftClass::clip);
    if (!std::exchange(is_counted_, true)) ++writer.stats().groups_changed;
  }
  /// Starts a new tree for the next point, even if the last one reached its bound.
  void start_anew(const SoftFrame& frame, const PreparedGroup& group, PixelWriter& writer) {
    const bool was_dropped = !use_tree_;
    if (!was_dropped) note_tree(writer.stats());
    start_tree(frame, group);
    if (!use_tree_ && !was_dropped) change_solver(writer);
    if (!was_dropped || !use_tree_) return;
    writer.answer_by(SoftClass::bsp);
    clip_what_the_tree_leaves(frame, group);
  }
  void drop_tree(const SoftFrame& frame, const PreparedGroup& group, PixelWriter& writer) {
    note_tree(writer.stats());
    use_tree_ = false;
    change_solver(writer);
    clip_what_the_tree_leaves(frame, group);
  }
  /// All candidates if there is no tree.
  void clip_what_the_tree_leaves(const SoftFrame& frame, const PreparedGroup& group) {
    if (use_tree_) return clip(frame, group.candidates, occluders_.indefinite);
    take_all(group.candidates, all_);
    clip(frame, group.candidates, all_);
  }
  void clip(const SoftFrame& frame, const GroupCandidates& candidates,
            std::span<const std::uint32_t> places) {
    clipped_ = order_.sorted(candidates, places);
    clip_.reset(candidates, clipped_, frame.stop);
  }
  /// Counts a tree that is done with.
  void note_tree(SoftStats& stats) const {
    stats.tree_nodes += bsp_.node_count();
    stats.peak_tree_bytes = std::max<std::uint64_t>(stats.peak_tree_bytes, bsp_.bytes());
  }

  void solve_point(const SoftFrame& frame, const PreparedGroup& group, std::uint32_t pixel,
                   PixelWriter& writer) {
    receiver_.take_up(frame, pixel);
    const PointSight sight = sight_of(frame, receiver_, pixel);
    visible_.clear();
    if (sight.above > 0) find_visible(frame, group, pixel, writer);
    if (sight.above > 0 && visible_.fragments == receiver_.light && !receiver_.plane.cuts_light &&
        !sight.horizon_cuts) {
      writer.count_solver(pixel);
      whole_.add(pixel, sight.at.to_origin, sight.at.normal);
      if (whole_.full()) finish_whole(frame, whole_, writer);
    } else {
      visible_.integrate(frame, sight, writer);
    }
  }

  void find_visible(const SoftFrame& frame, const PreparedGroup& group, std::uint32_t pixel,
                    PixelWriter& writer) {
    const GroupPoint at = group_point(group.candidates.axes, frame.points.positions[pixel],
                                      receiver_.plane.id, receiver_.plane.tau);
    const FragmentList<T>& light = receiver_.light;
    if (use_tree_ && !query_tree(light, at)) {
      visible_.clear();
      drop_tree(frame, group, writer);
    }
    clip_.move_to(at);
    if (!use_tree_) return clip_all(light, visible_.fragments);
    if (clipped_.empty()) return;
    visible_.scratch.clear();
    clip_all(visible_.fragments, visible_.scratch);
    visible_.fragments.swap(visible_.scratch);
  }
  bool query_tree(const FragmentList<T>& light, const GroupPoint& at) {
    for (std::size_t i = 0; i < light.size(); ++i) {
      if (!query_.query(bsp_, occluders_.lines.data(), loaded(light[i]), at.from_centre, visible_.fragments))
        return false;
    }
    return true;
  }
  void clip_all(const FragmentList<T>& parts, FragmentList<T>& out) {
    for (std::size_t i = 0; i < parts.size(); ++i) clip_.query(loaded(parts[i]), out);
  }

  GroupOccluders occluders_;
  LineClassBsp bsp_;
  bool use_tree_ = false;
  bool is_counted_ = false;  ///< the group, as one that changed its solver
  LineClassQuery<T> query_;
  CandidateOrder order_;
  std::vector<std::uint32_t> all_;
  std::span<const std::uint32_t> clipped_;
  ClipSolver<OnePoint<T>> clip_;
  ReceiverSight<T> receiver_;
  VisibleLight<T> visible_;
  WholePoints whole_;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
