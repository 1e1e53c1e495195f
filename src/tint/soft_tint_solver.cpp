// The points of a group, one by one: the light cut along the shadows of see-through triangles, or places of
// it counted.
#include "tint/soft_tint.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tint/soft_tint_solver.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"

#include "soft/clip/clip_solver-inl.h"
#include "soft/silhouette/silhouette_solver-inl.h"
#include "soft/solve/point_sight-inl.h"
#include "tint/light_grid-inl.h"
#include "tint/shadows_on_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra {
extern template class soft::HWY_NAMESPACE::ClipSolver<
    soft::HWY_NAMESPACE::OnePoint<float>>;  // soft/solve/point_solver.cpp
}
namespace tenebra::tint::HWY_NAMESPACE {
namespace {
using namespace soft::HWY_NAMESPACE;
using namespace simd::HWY_NAMESPACE;
using glm::dvec2;
using glm::dvec3;
using glm::vec3;
using soft::GroupPoint;
using soft::LightFrame;
using soft::SoftFrame;

using Polygon = LightPolygon<float>;
using Fragments = FragmentList<float>;

class Solver final : public SoftTintSolver {
public:
  void solve(const SoftTintFrame& frame, const SoftTintTask& task, TintMask& found,
             TintStats& stats) override {
    frame_ = &frame;
    task_ = &task;
    receiver_.forget();
    grid_.set_side(frame.grid_side);
    glass_.reset(frame, task.numbers);
    clip_.reset(task.group.candidates, task.group.clipped, frame.soft.stop);
    if (!task.group.silhouette.empty()) silhouette_.reset(task.group.silhouette);
    for (const std::uint32_t pixel : task.pixels) {
      if (stop_requested(frame.soft.stop)) return;
      if (frame.mask.irradiance[pixel] > 0) solve_point(pixel, found, stats);
    }
  }

private:
  void solve_point(std::uint32_t pixel, TintMask& found, TintStats& stats) {
    const SoftFrame& soft = frame_->soft;
    receiver_.take_up(soft, pixel);
    sight_ = sight_of(soft, receiver_, pixel);
    if (!(sight_.above > 0)) return;
    const bool cuts = find_shadows(soft.points.positions[pixel]);
    stats.tests += shadows_.size();
    if (shadows_.empty()) return;
    point_ = group_point(task_->group.candidates.axes, soft.points.positions[pixel], receiver_.plane.id,
                         receiver_.plane.tau);
    clip_.move_to(point_);
    if (!task_->group.silhouette.empty()) silhouette_.move_to(point_);
    if (!cuts) ++stats.numeric;
    const vec3 factor = cuts ? by_pieces(frame_->mask.irradiance[pixel]) : by_places();
    if (factor == vec3(1.0f)) return;
    found.pixels.push_back(pixel);
    found.factors.push_back(factor);
  }

  /// Fills shadows_; returns whether they are few and of one transmittance each.
  bool find_shadows(const dvec3& point) {
    glass_.find(*frame_, point, receiver_.plane.id, receiver_.plane.tau, shadows_);
    return shadows_.size() <= most_cut &&
           std::none_of(shadows_.begin(), shadows_.end(),
                        [&](const TintShadow& shadow) { return frame_->panes.varies(shadow.number); });
  }

  static double value(const dvec3& line, const dvec2& at) { return line.x * at.x + line.y * at.y + line.z; }

  // Pieces.

  vec3 by_pieces(double whole) {
    pieces_.clear();
    factors_.clear();
    for (std::size_t i = 0; i < receiver_.light.size(); ++i) pieces_.push(loaded(receiver_.light[i]));
    factors_.assign(pieces_.size(), vec3(1.0f));
    for (const TintShadow& shadow : shadows_) cut_all(shadow);
    dvec3 lost(0.0);
    if (frame_->own_irradiance) whole = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const bool clear = factors_[i] == vec3(1.0f);
      if (clear && !frame_->own_irradiance) continue;
      const double light = seen_of(loaded(pieces_[i]));
      if (frame_->own_irradiance) whole += light;
      lost += light * dvec3(1.0f - factors_[i]);
    }
    if (!(whole > 0)) return vec3(1.0f);
    return vec3(glm::clamp(1.0 - lost / whole, 0.0, 1.0));
  }

  void cut_all(const TintShadow& shadow) {
    const vec3 factor = frame_->panes.constant(shadow.number);
    LightLine<float> lines[4];
    for (int k = 0; k < 4; ++k) lines[k] = line_of<float>(shadow.lines[k]);
    next_.clear();
    next_factors_.clear();
    for (std::size_t i = 0; i < pieces_.size(); ++i) cut(loaded(pieces_[i]), factors_[i], lines, factor);
    pieces_.swap(next_);
    factors_.swap(next_factors_);
  }

  void cut(const Polygon& piece, const vec3& before, const LightLine<float> (&lines)[4], const vec3& factor) {
    const std::size_t first = next_.size();
    Polygon rest = piece;
    for (const LightLine<float>& line : lines) {
      const LineValues<float> values = evaluate(rest, line);
      if (values.positive == 0) {  // none of it is in the shadow
        next_.shrink(first);
        return push(piece, before);
      }
      if (values.negative == 0) continue;
      Polygon inside, outside;
      split(rest, values, inside, outside);
      next_.push(outside);
      rest = inside;
    }
    next_factors_.resize(next_.size(), before);
    push(rest, before * factor);
  }

  void push(const Polygon& piece, const vec3& factor) {
    next_.push(piece);
    next_factors_.resize(next_.size(), factor);
  }

  /// Fills found_ with the rest of a part of the light after the opaque casters and the horizon.
  void find_visible(const Polygon& part) {
    clip_.query(part, found_);
    if (!task_->group.silhouette.empty() && !found_.empty()) {
      scratch_.clear();
      for (std::size_t i = 0; i < found_.size(); ++i) silhouette_.query(loaded(found_[i]), nullptr, scratch_);
      found_.swap(scratch_);
    }
    if (sight_.horizon_cuts) keep_positive(found_, line_of<float>(sight_.horizon), scratch_);
  }

  double seen_of(const Polygon& part) {
    found_.clear();
    find_visible(part);
    edges_.count = 0;
    append_edges(found_, edges_);
    return std::max(0.0, sum_edges(edges_, frame_->soft.light, sight_.at).irradiance);
  }

  // Places.

  vec3 by_places() {
    visible_.clear();
    for (std::size_t i = 0; i < receiver_.light.size(); ++i) {
      found_.clear();
      find_visible(loaded(receiver_.light[i]));
      for (std::size_t k = 0; k < found_.size(); ++k) visible_.push(loaded(found_[k]));
    }
    grid_.start(visible_);
    for (std::size_t i = 0; i < visible_.size(); ++i)
      grid_.weigh(visible_[i], [this](Double8 x, Double8 y) { return weight_at(x, y); });
    const double sum = grid_.total();
    if (!(sum > 0)) return by_middles();
    for (const TintShadow& shadow : shadows_) pass(shadow);
    return vec3(glm::clamp(grid_.passed() / sum, 0.0, 1.0));
  }

  dvec3 way_to(const dvec2& at) const {
    const LightFrame& light = frame_->soft.light;
    return sight_.at.to_origin + at.x * light.ex + at.y * light.ey;
  }

  /// The form factor's kernel, in units of the light.
  Double8 weight_at(Double8 x, Double8 y) const {
    const LightFrame& light = frame_->soft.light;
    const Vector8 way = broadcast8(sight_.at.to_origin) + x * broadcast8(light.ex) + y * broadcast8(light.ey);
    const Double8 square = dot_unfused(way, way), zero = broadcast8(0.0);
    const Double8 here = max(zero, dot_unfused(broadcast8(sight_.at.normal), way));
    const Double8 there = max(zero, zero - dot_unfused(broadcast8(light.normal), way));
    return here * there / (square * square) * broadcast8(glm::dot(light.ex, light.ex));
  }

  double weight_at(const dvec2& at) const {
    double weights[8];
    store(weight_at(broadcast8(at.x), broadcast8(at.y)), weights);
    return weights[0];
  }

  void pass(const TintShadow& shadow) {
    const Cells cells = grid_.cells_between(shadow.low, shadow.high);
    if (!frame_->panes.varies(shadow.number))
      return grid_.pass(shadow.lines, cells, frame_->panes.constant(shadow.number));
    grid_.pass(shadow.lines, cells, [&](const dvec2& at) { return transmittance(shadow, at); });
  }

  static bool in_shadow(const TintShadow& shadow, const dvec2& at) {
    for (const dvec3& line : shadow.lines)
      if (!(value(line, at) > 0)) return false;
    return true;
  }

  vec3 transmittance(const TintShadow& shadow, const dvec2& at) const {
    const Panes& panes = frame_->panes;
    if (!panes.varies(shadow.number)) return panes.constant(shadow.number);
    const points::Corners c = points::corners_of(frame_->soft.triangles, panes.ids()[shadow.number]);
    return panes.transmittance(shadow.number,
                               weights_where(c.v, frame_->soft.points.positions[sight_.pixel], way_to(at)));
  }

  /// Where the visible parts fall between all places: the middle of each stands for it.
  vec3 by_middles() const {
    dvec3 light(0.0);
    double sum = 0;
    for (std::size_t i = 0; i < visible_.size(); ++i) {
      const StoredPolygon<float>& f = visible_[i];
      dvec2 middle(0.0);
      double area = 0;
      for (int k = 0; k < f.count; ++k) {
        const int next = k + 1 < f.count ? k + 1 : 0;
        middle += dvec2(f.x[k], f.y[k]) / static_cast<double>(f.count);
        area += 0.5 * (double(f.x[k]) * double(f.y[next]) - double(f.x[next]) * double(f.y[k]));
      }
      const double weight = std::max(0.0, area) * weight_at(middle);
      vec3 passed(1.0f);
      for (const TintShadow& shadow : shadows_)
        if (in_shadow(shadow, middle)) passed *= transmittance(shadow, middle);
      sum += weight;
      light += weight * dvec3(passed);
    }
    return sum > 0 ? vec3(glm::clamp(light / sum, 0.0, 1.0)) : vec3(1.0f);
  }

  const SoftTintFrame* frame_ = nullptr;
  const SoftTintTask* task_ = nullptr;
  ClipSolver<OnePoint<float>> clip_;
  SilhouetteSolver<float> silhouette_;
  ReceiverSight<float> receiver_;
  PointSight sight_;
  GroupPoint point_;  ///< clip_ refers to it
  ShadowsOnLight glass_;
  std::vector<TintShadow> shadows_;
  Fragments pieces_, next_, found_, scratch_, visible_;
  std::vector<vec3> factors_, next_factors_;  ///< of each piece
  LightEdges edges_;
  LightGrid grid_;
};

}  // namespace

std::unique_ptr<SoftTintSolver> make_solver() {
  return std::make_unique<Solver>();
}

}  // namespace tenebra::tint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::tint {

std::unique_ptr<SoftTintSolver> make_soft_tint_solver(SimdLevel level) {
  return TENEBRA_DISPATCH(level, make_solver)();
}

}  // namespace tenebra::tint
#endif
