// Points one by one: occluders are clipped from the light, and then what the silhouette of meshes hides.
// Included once per target.
#if defined(TENEBRA_SOFT_POINT_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_POINT_SOLVER_INL_H_
#undef TENEBRA_SOFT_POINT_SOLVER_INL_H_
#else
#define TENEBRA_SOFT_POINT_SOLVER_INL_H_
#endif

#include "soft/clip/clip_solver-inl.h"
#include "soft/silhouette/silhouette_solver-inl.h"
#include "soft/solve/point_sight-inl.h"
#include "soft/solve/solvers.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

template <class T>
class PointSolver final : public Solver {
public:
  void begin(const SoftFrame& frame, const PreparedGroup& group) override {
    receiver_.forget();
    clip_.reset(group.candidates, group.clipped, frame.stop);
    if (!group.silhouette.empty()) silhouette_.reset(group.silhouette);
  }

  void solve(const SoftFrame& frame, const PreparedGroup& group, std::span<const std::uint32_t> pixels,
             PixelWriter& writer) override {
    for (const std::uint32_t pixel : pixels) {
      if (stop_requested(frame.stop)) break;
      solve_point(frame, group, pixel, writer);
    }
    finish_whole(frame, whole_, writer);
  }

private:
  void solve_point(const SoftFrame& frame, const PreparedGroup& group, std::uint32_t pixel,
                   PixelWriter& writer) {
    receiver_.take_up(frame, pixel);
    const PointSight sight = sight_of(frame, receiver_, pixel);
    visible_.clear();
    if (sight.above > 0) find_visible(frame, group, sight);
    if (sight.above > 0 && visible_.fragments == receiver_.light && !receiver_.plane.cuts_light &&
        !sight.horizon_cuts) {  // nothing is hidden: it is finished with seven others
      writer.count_solver(pixel);
      whole_.add(pixel, sight.at.to_origin, sight.at.normal);
      if (whole_.full()) finish_whole(frame, whole_, writer);
    } else {
      visible_.integrate(frame, sight, writer);
    }
  }

  /// Finds fragments, and where those will not be cut again, edges of the boundary of others.
  void find_visible(const SoftFrame& frame, const PreparedGroup& group, const PointSight& sight) {
    const GroupPoint at = group_point(group.candidates.axes, frame.points.positions[sight.pixel],
                                      receiver_.plane.id, receiver_.plane.tau);
    FragmentList<T>& found = visible_.fragments;
    clip_.move_to(at);
    for (std::size_t i = 0; i < receiver_.light.size(); ++i) clip_.query(loaded(receiver_.light[i]), found);
    if (group.silhouette.empty() || found.empty()) return;
    silhouette_.move_to(at);
    visible_.scratch.clear();
    for (std::size_t i = 0; i < found.size(); ++i)
      silhouette_.query(loaded(found[i]), sight.horizon_cuts ? nullptr : &visible_.edges, visible_.scratch);
    found.swap(visible_.scratch);
  }

  ClipSolver<OnePoint<T>> clip_;
  SilhouetteSolver<T> silhouette_;
  ReceiverSight<T> receiver_;
  VisibleLight<T> visible_;
  WholePoints whole_;  ///< points put aside until there are eight
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
