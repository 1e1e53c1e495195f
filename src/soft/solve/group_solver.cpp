#include "soft/solve/group_solver.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/solve/group_solver.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>
#include "simd/dispatch.h"

#include "base/stopwatch.h"
#include "soft/bsp/line_class_query-inl.h"
#include "soft/clip/clip_solver-inl.h"
#include "soft/clip/packet_solver-inl.h"
#include "soft/groups/point_groups.h"
#include "soft/occluders/candidate_order.h"
#include "soft/occluders/family_candidates.h"
#include "soft/occluders/quads.h"
#include "soft/polygon/receiver_plane-inl.h"
#include "soft/polygon/whole_light-inl.h"
#include "soft/silhouette/outline_solver-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Trees beyond this size are dropped, and the rest of the group is clipped.
inline constexpr std::size_t largest_tree_bytes = std::size_t{4} << 20;

/// The solvers for one precision and their buffers.
template <class T>
struct Precision {
  LineClassQuery<T> query;
  ClipSolver<OnePoint<T>> clip;
  OutlineSolver<T> outline;
  FragmentList<T> start, visible, scratch;
};

class Solver final : public GroupSolver {
public:
  explicit Solver(FindCandidates find_candidates) : find_candidates_(find_candidates) {}

  void solve(const SoftFrame& frame, const GroupTask& task) override {
    base::Stopwatch watch;
    set_up(frame, task);
    solve_ready(frame, task, watch);
  }

  void solve_together(const SoftFrame& frame, const GroupFrame& around,
                      std::span<const GroupTask> tasks) override {
    base::Stopwatch watch;
    family_.clear();
    for (const GroupTask& task : tasks) family_.add(task.candidates);
    set_up(frame, {{}, around, family_.triangles()});
    times.init_ms += watch.lap_ms();
    if (!outline_.empty()) {  // each had better have an outline of its own
      for (const GroupTask& task : tasks) solve(frame, task);
      return;
    }
    family_.make_ready(candidates_, clipped_);
    for (std::size_t k = 0; k < tasks.size(); ++k) {
      clipped_ = family_.choose(k, tasks[k].frame, candidates_);
      solve_ready(frame, tasks[k], watch);
      family_.restore(candidates_);
    }
  }

  void solve_lit(const SoftFrame& frame, std::span<const std::span<const std::uint32_t>> groups) override {
    base::Stopwatch watch;
    receiver_ = {};
    use_bsp_ = false;
    outline_.clear();
    candidates_.clear();
    candidates_.axes = light_axes(frame.light, glm::dvec3(0.0));
    clipped_ = {};
    double_.clip.reset(candidates_, clipped_);
    for (const auto& pixels : groups) solve_lit(frame, pixels);
    finish_lit(frame);
    times.irradiance_ms += watch.lap_ms();
  }

  void expect(const SoftFrame& frame, std::span<const std::uint32_t> pixels,
              std::span<const std::uint32_t> after) const override {
    for (std::size_t i = 0; i < HWY_MIN(after.size(), std::size_t{largest_neighbourhood}); i += 16)
      fetch_soon(&after[i]);
    const std::size_t end = HWY_MIN(pixels.size(), std::size_t{largest_neighbourhood});
    for (std::size_t i = 0; i < end; i += 2) {  // along the Z curve two of a row at a time
      const std::uint32_t pixel = pixels[i];
      fetch_soon(&frame.points.positions[pixel]);
      fetch_soon(&frame.points.triangles[pixel]);
      if (!frame.normals.empty()) fetch_soon(&frame.normals[pixel]);
    }
  }

private:
  void solve_lit(const SoftFrame& frame, std::span<const std::uint32_t> pixels) {
    for (const std::uint32_t pixel : pixels) {
      if (frame.points.triangles[pixel] != receiver_.id)
        start_on(double_, frame, frame.points.triangles[pixel]);
      if (above_ > 0 && !receiver_.cuts_light) {
        whole_.add(pixel, frame.light.origin - frame.points.positions[pixel], normal_at(frame, pixel));
        if (whole_.full()) finish_lit(frame);
      } else {
        solve_cut(frame, pixel);
      }
    }
  }

  /// After set_up(), which `watch` has seen begin.
  void solve_ready(const SoftFrame& frame, const GroupTask& task, base::Stopwatch& watch) {
    receiver_ = {};
    const bool wide = frame.config.precision == SoftPrecision::reference;
    const bool packets = !wide && wants_packets(frame);
    if (wide) {
      reset(double_);
    } else if (packets) {
      packet_.reset(candidates_, clipped_);
      clip_is_ready_ = false;
    } else {
      reset(float_);
    }
    times.init_ms += watch.lap_ms();
    if (wide) {
      solve_points(double_, frame, task);
    } else if (packets) {
      solve_packets(frame, task.pixels);
    } else {
      solve_points(float_, frame, task);
    }
    times.query_ms += watch.lap_ms();
  }

  /// Of lit points: a horizon may cut the light.
  void solve_cut(const SoftFrame& frame, std::uint32_t pixel) {
    solve_point(double_, frame, pixel);
    if (frame.classes[pixel] == class_of(SoftClass::clip)) frame.classes[pixel] = class_of(SoftClass::lit);
  }

  void finish_lit(const SoftFrame& frame) {
    const std::size_t count = whole_.count;
    std::uint32_t pixels[8];
    std::copy_n(whole_.pixels, count, pixels);
    const std::uint32_t seen = finish_whole(frame);
    for (std::size_t k = 0; k < count; ++k) {
      if ((seen >> k & 1u) != 0) {
        frame.classes[pixels[k]] = class_of(SoftClass::lit);
      } else {
        solve_cut(frame, pixels[k]);
      }
    }
  }

  void set_up(const SoftFrame& frame, const GroupTask& task) {
    outline_.clear();
    find_candidates_(frame.light, frame.triangles, task.frame, task.candidates, candidates_);
    use_bsp_ = wants_bsp(frame.config);
    if (use_bsp_) {
      set_up_occluders(frame.light, frame.triangles, task.frame, candidates_, occluders_);
      bsp_.reset(occluders_, frame.triangles, task.frame, frame.config.choice);
      clipped_ = order_.sorted(candidates_, occluders_.indefinite);
    } else {
      if (frame.config.solver == SoftSolver::automatic) {
        finder_.find(frame.light, frame.triangles, candidates_, outline_, rest_);
        drop_beside_light(task.frame, candidates_.axes, outline_);
        pair_triangles(task.frame, candidates_, rest_);
      } else {
        take_all();
      }
      clipped_ = order_.sorted(candidates_, rest_);
    }
  }

  void take_all() {
    rest_.resize(candidates_.all.size());
    std::iota(rest_.begin(), rest_.end(), 0u);
  }

  template <class T>
  void reset(Precision<T>& p) {
    p.clip.reset(candidates_, clipped_);
    if (!outline_.empty()) p.outline.reset(outline_);
  }

  template <class T>
  void solve_points(Precision<T>& p, const SoftFrame& frame, const GroupTask& task) {
    for (std::size_t i = 0; i < task.pixels.size(); ++i) {
      const std::uint32_t pixel = task.pixels[i];
      if (stop_requested(frame.stop)) break;
      if (use_bsp_ && bsp_.bytes() > largest_tree_bytes) {
        note_tree();
        use_bsp_ = false;
        take_all();
        clipped_ = order_.sorted(candidates_, rest_);
        p.clip.reset(candidates_, clipped_);
      }
      solve_point(p, frame, pixel);
      if (use_bsp_ && !frame.config.keep_trees) {
        note_tree();
        bsp_.reset(occluders_, frame.triangles, task.frame, frame.config.choice);
      }
    }
    finish_whole(frame);
    if (use_bsp_) note_tree();
  }

  /// Sixteen points together. Cutting along an outline gains nothing by that: it has lanes enough.
  bool wants_packets(const SoftFrame& frame) const {
    return frame.config.solver == SoftSolver::automatic && outline_.empty() &&
           clipped_.size() <= PacketSolver::most_occluders &&
           frame.light.outline.size() <= PacketSolver::most_light_vertices;
  }

  void solve_packets(const SoftFrame& frame, std::span<const std::uint32_t> pixels) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::uint32_t pixel = pixels[i], receiver = frame.points.triangles[pixel];
      if (receiver != receiver_.id) start_on(float_, frame, receiver);
      const glm::dvec3& position = frame.points.positions[pixel];
      if (!(above_ > 0) || !is_in_front(frame, frame.light.origin - position)) {
        solve_point(float_, frame, pixel);  // sees nothing: no solver is asked
        continue;
      }
      packet_pixels_[packet_.count()] = pixel;
      packet_above_[packet_.count()] = above_;
      packet_.add(position, normal_at(frame, pixel), receiver_);
      if (packet_.full()) finish_packet(frame);
    }
    finish_packet(frame);
    finish_whole(frame);
  }

  void solve_alone(const SoftFrame& frame, std::uint32_t pixel) {
    if (!std::exchange(clip_is_ready_, true)) float_.clip.reset(candidates_, clipped_);
    solve_point(float_, frame, pixel);
  }

  void finish_packet(const SoftFrame& frame) {
    if (packet_.count() == 0) return;
    const bool solved = packet_.solve(frame.light, candidates_.axes);
    for (std::size_t k = 0; k < packet_.count(); ++k) {
      const std::uint32_t pixel = packet_pixels_[k];
      if (!solved) {
        solve_alone(frame, pixel);
        continue;
      }
      if (!packet_.sees_all(k)) {
        store(frame, pixel, packet_.area(k), packet_.irradiance(k), packet_above_[k]);
        continue;
      }
      count_solver(frame, pixel);
      whole_.add(pixel, packet_.to_origin(k), packet_.normal(k));
      if (whole_.full()) finish_whole(frame);
    }
    if (solved) stats.fragments += packet_.fragments();
    packet_.clear();
  }

  /// Counts a tree that is given up.
  void note_tree() {
    stats.tree_nodes += bsp_.node_count();
    stats.peak_tree_bytes = std::max<std::uint64_t>(stats.peak_tree_bytes, bsp_.bytes());
  }

  /// Clipping was the faster on every frame measured (by 1.0 to 2 times): the BSP is there by name.
  static bool wants_bsp(const SoftShadowConfig& config) { return config.solver == SoftSolver::bsp; }

  template <class T>
  void solve_point(Precision<T>& p, const SoftFrame& frame, std::uint32_t pixel) {
    const std::uint32_t receiver = frame.points.triangles[pixel];
    if (receiver != receiver_.id) start_on(p, frame, receiver);
    const glm::dvec3 point = frame.points.positions[pixel];
    const bool in_front = glm::dot(point - frame.light.origin, frame.light.normal) > 0;
    const double above = in_front ? above_ : 0.0;
    const Receiver3 at{frame.light.origin - point, normal_at(frame, pixel)};
    const glm::dvec3 horizon = line_of_plane(frame.light, at.normal, at.to_origin);
    const bool horizon_cuts = cuts(frame.light, horizon);
    p.visible.clear();
    edges_.count = 0;
    if (above > 0)
      find_visible(p, group_point(candidates_.axes, point, receiver, receiver_.tau), horizon_cuts);
    if (above > 0 && p.visible == p.start && add_whole(frame, pixel)) {
      count_solver(frame, pixel);
      if (whole_.full()) finish_whole(frame);
    } else {
      finish(p, frame, pixel, at, above, horizon_cuts ? &horizon : nullptr);
    }
  }

  /// Takes up another receiver: the part of the light above its plane is the same for all its points.
  template <class T>
  void start_on(Precision<T>& p, const SoftFrame& frame, std::uint32_t receiver) {
    receiver_ = receiver_plane(frame.light, frame.view, frame.triangles, receiver);
    p.start.clear();
    p.start.push(polygon_of<T>(frame.light.outline));
    keep_positive(p.start, line_of<T>(receiver_.horizon), p.scratch);
    receiver_.line = line_of<float>(receiver_.horizon);
    receiver_.cuts_light = cuts(frame.light, receiver_.horizon);
    above_ = receiver_.face == glm::dvec3(0.0) ? 0.0 : area_of(p.start);
  }

  glm::dvec3 normal_at(const SoftFrame& frame, std::uint32_t pixel) const {
    return frame.normals.empty() ? receiver_.face : glm::dvec3(frame.normals[pixel]);
  }

  bool is_in_front(const SoftFrame& frame, const glm::dvec3& to_origin) const {
    return glm::dot(to_origin, frame.light.normal) < 0;
  }

  /// Puts aside a point on receiver_ that nothing stands in front of, to be finished with seven others; false
  /// if a horizon cuts the light.
  bool add_whole(const SoftFrame& frame, std::uint32_t pixel) {
    const glm::dvec3 to_origin = frame.light.origin - frame.points.positions[pixel];
    const glm::dvec3 normal = normal_at(frame, pixel);
    if (receiver_.cuts_light || cuts(frame.light, line_of_plane(frame.light, normal, to_origin)))
      return false;
    whole_.add(pixel, to_origin, normal);
    return true;
  }

  /// Returns bits of those put aside that see the whole light, and forgets them all.
  std::uint32_t finish_whole(const SoftFrame& frame) {
    if (whole_.count == 0) return 0;
    double irradiance[8];
    const std::uint32_t seen = irradiance_of_whole(frame.light, whole_, irradiance);
    for (std::size_t k = 0; k < whole_.count; ++k) {
      if ((seen >> k & 1u) == 0) continue;
      frame.out.visible_fraction[whole_.pixels[k]] = 1.0f;
      frame.out.irradiance[whole_.pixels[k]] = clamped(irradiance[k]);
    }
    const auto count = static_cast<std::uint64_t>(std::popcount(seen));
    stats.points_lit += count;
    stats.fragments += count;
    whole_.count = 0;
    return seen;
  }

  static float clamped(double irradiance) {
    return static_cast<float>(std::clamp(irradiance, 0.0, 3.141592653589793));
  }

  /// Finds what is visible: fragments, and where those will not be cut again, edges of the border of others.
  template <class T>
  void find_visible(Precision<T>& p, const GroupPoint& at, bool will_be_cut) {
    p.clip.move_to(at);
    for (std::size_t i = 0; i < p.start.size(); ++i) {
      const LightPolygon<T> part = loaded(p.start[i]);
      if (use_bsp_) {
        p.query.query(bsp_, occluders_.lines.data(), part, at.from_centre, p.visible);
      } else {
        p.clip.query(part, p.visible);
      }
    }
    if (use_bsp_ && !clipped_.empty()) refine(p, p.clip);
    if (outline_.empty() || p.visible.empty()) return;
    p.outline.move_to(at);
    p.scratch.clear();
    for (std::size_t i = 0; i < p.visible.size(); ++i)
      p.outline.query(loaded(p.visible[i]), will_be_cut ? nullptr : &edges_, p.scratch);
    p.visible.swap(p.scratch);
  }

  /// Replaces the fragments found so far by what `solver` leaves of them.
  template <class T, class S>
  void refine(Precision<T>& p, S& solver) {
    p.scratch.clear();
    for (std::size_t i = 0; i < p.visible.size(); ++i) solver.query(loaded(p.visible[i]), p.scratch);
    p.visible.swap(p.scratch);
  }

  template <class T>
  double area_of(const FragmentList<T>& fragments) {
    double area = 0;
    for (std::size_t i = 0; i < fragments.size(); ++i) {
      const StoredPolygon<T>& f = fragments[i];
      for (int k = 0; k < f.count; ++k) {
        const int next = k + 1 < f.count ? k + 1 : 0;
        area += (double(f.x[k]) * double(f.y[next]) - double(f.x[next]) * double(f.y[k])) / 2;
      }
    }
    return area;
  }

  /// Integrates what is visible. Its time is a part of the query's where points are solved one by one.
  template <class T>
  void finish(Precision<T>& p, const SoftFrame& frame, std::uint32_t pixel, const Receiver3& at, double above,
              const glm::dvec3* horizon) {
    append_edges(p.visible, edges_);
    EdgeSums sums = sum_edges(edges_, frame.light, at);
    const double area = sums.area;
    if (horizon != nullptr) {
      keep_positive(p.visible, line_of<T>(*horizon), p.scratch);
      edges_.count = 0;
      append_edges(p.visible, edges_);
      sums = sum_edges(edges_, frame.light, at);
    }
    stats.fragments += p.visible.size();
    store(frame, pixel, area, sums.irradiance, above);
  }

  /// `above`: area of the light above the horizon.
  void store(const SoftFrame& frame, std::uint32_t pixel, double area, double irradiance, double above) {
    const double fraction = std::clamp(area / frame.light.area, 0.0, 1.0);
    frame.out.visible_fraction[pixel] = static_cast<float>(fraction);
    frame.out.irradiance[pixel] = clamped(irradiance);
    count(above, area, frame, pixel);
  }

  void count(double above, double area, const SoftFrame& frame, std::uint32_t pixel) {
    if (above <= 0) {
      frame.classes[pixel] = class_of(SoftClass::below_horizon);
      return;
    }
    count_solver(frame, pixel);
    const bool dark = area <= 0, lit = area >= above * (1 - 1e-6);
    ++(dark ? stats.points_dark : lit ? stats.points_lit : stats.points_penumbra);
  }

  /// Counts a point for the solver at work.
  void count_solver(const SoftFrame& frame, std::uint32_t pixel) {
    const bool outlined = !outline_.empty();
    ++(use_bsp_ ? stats.points_bsp : outlined ? stats.points_outline : stats.points_clip);
    frame.classes[pixel] = class_of(use_bsp_   ? SoftClass::bsp
                                    : outlined ? SoftClass::outline
                                               : SoftClass::clip);
  }

  static std::uint8_t class_of(SoftClass soft_class) { return static_cast<std::uint8_t>(soft_class); }

  static bool cuts(const LightFrame& light, const glm::dvec3& line) {
    for (const glm::dvec2& at : light.outline) {
      if (!(line.x * at.x + line.y * at.y + line.z > 0)) return true;
    }
    return false;
  }

  FindCandidates find_candidates_;
  GroupCandidates candidates_;
  OutlineFinder finder_;
  FamilyCandidates family_;
  GroupOutline outline_;
  std::vector<std::uint32_t> rest_;  ///< places of the candidates that the outline leaves
  CandidateOrder order_;
  std::span<const std::uint32_t> clipped_;  ///< places of the candidates that are clipped, largest first
  GroupOccluders occluders_;                ///< of the BSP
  LineClassBsp bsp_;
  bool use_bsp_ = false;
  Precision<float> float_;
  Precision<double> double_;
  ReceiverPlane receiver_;
  double above_ = 0;  ///< area of the light above its horizon
  PacketSolver packet_;
  std::uint32_t packet_pixels_[packet_size] = {};
  double packet_above_[packet_size] = {};  ///< above_ of these
  bool clip_is_ready_ = false;             ///< where packets are at work, whether points alone can be solved
  LightEdges edges_;
  WholePoints whole_;  ///< points put aside
};

std::unique_ptr<GroupSolver> make_solver(FindCandidates find_candidates) {
  return std::make_unique<Solver>(find_candidates);
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

std::unique_ptr<GroupSolver> make_group_solver(SimdLevel level) {
  const FindCandidates find = find_candidates_kernel(level);
  return TENEBRA_DISPATCH(level, make_solver)(find);
}

}  // namespace tenebra::soft
#endif
