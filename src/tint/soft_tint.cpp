#include "tint/soft_tint.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel/parallel.h"
#include "points/contact_rule.h"
#include "soft/groups/group_tree.h"

namespace tenebra::tint {
namespace {

using glm::dvec3;

/// What its vertices' rounding can put the light's plane and polygon off by.
double light_tolerance(const AreaLight& light) {
  glm::vec3 most(0.0f);
  for (const glm::vec3& v : light.vertices) most = glm::max(most, glm::abs(v));
  const glm::vec3 thrice[3] = {most, most, most};
  return 4 * points::rounding_tolerance(thrice);
}

LightReach reach_of(const AreaLight& light, double tolerance, const TriangleView& triangles,
                    const Panes& panes) {
  LightReach reach;
  reach.at_infinity = light.at_infinity;
  for (const std::uint32_t id : panes.ids())
    for (int k = 0; k < 3; ++k)
      reach.farthest =
          std::max(reach.farthest, soft::largest(triangles.positions[triangles.triangles[id][k]]));
  if (light.at_infinity) reach.box.add(light.centre);
  for (const glm::vec3& v : light.vertices) reach.box.add(dvec3(v));
  if (light.at_infinity)
    for (const glm::dvec2& v : light.polygon) reach.box.add(light.centre + v.x * light.ex + v.y * light.ey);
  const double wider = light.at_infinity ? 0x1p-40 : tolerance;
  reach.box.low -= wider, reach.box.high += wider;
  return reach;
}

soft::GroupFrame frame_of(const soft::PointGroup& group, const soft::PointGroups& groups,
                          std::vector<std::uint32_t>& receivers) {
  soft::GroupFrame frame;
  receivers.clear();
  for (const soft::Receiver& receiver : groups.receivers_of(group)) {
    receivers.push_back(receiver.triangle);
    frame.receiver_tau = std::max(frame.receiver_tau, receiver.tau);
  }
  frame.centre = 0.5 * (group.low + group.high);
  frame.half = glm::max(group.high - frame.centre, frame.centre - group.low);
  frame.receivers = receivers;
  return frame;
}

}  // namespace

int grid_side_for(double error_255) {
  int side = 64;
  while (side > 8 && 0.5 * std::pow(side / 2, -1.5) <= 0.5 * error_255 / 255) side /= 2;
  return side;
}

/// A ray of the sun p + t q has |q| >= 1, and no two places are farther apart than sqrt(3) times the sum of
/// their largest coordinates. With all q times t in the box, the hull of both boxes holds it.
math::Box<double> LightReach::box_from(const math::Box<double>& from) const {
  if (!at_infinity) return box;
  const double t = 2 * (farthest + std::max(soft::largest(from.low), soft::largest(from.high)));
  return {from.low + t * box.low, from.high + t * box.high};
}

/// Of all groups those with light of their own, and something see-through on its way.
void SoftTint::choose_groups(const PaneTree& tree, const LightReach& light, const SoftMask& mask) {
  std::vector<std::uint8_t> wanted(all_.groups.size(), 0);
  parallel::parallel_ranges(all_.groups.size(), 64, [&](std::size_t first, std::size_t last) {
    std::vector<trees::BlockTriangles> near;
    for (std::size_t i = first; i < last; ++i) {
      const soft::PointGroup& group = all_.groups[i];
      const auto pixels = all_.pixels_of(group);
      if (std::none_of(pixels.begin(), pixels.end(), [&](std::uint32_t p) { return mask.irradiance[p] > 0; }))
        continue;
      near.clear();
      const math::Box<double> points{group.low, group.high};
      tree.find(trees::shaft_between(points, light.box_from(points)), near);
      wanted[i] = !near.empty();
    }
  });
  std::vector<soft::GroupKey> keys;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i] != 0)
      keys.push_back({glm::vec3(0.5 * (all_.groups[i].low + all_.groups[i].high)), &all_.groups[i]});
  groups_.width = all_.width;
  groups_.pixels.swap(all_.pixels);
  groups_.receivers.swap(all_.receivers);
  soft::build_group_tree(keys, groups_);
}

void SoftTint::solve_group(const SoftTintFrame& frame, const PaneTree& tree, const LightReach& light,
                           const soft::GroupDecision& decision, Worker& worker) {
  if (decision.kind == soft::GroupClass::dark) return;
  const soft::PointGroup& group = *decision.group;
  worker.near.clear();
  const math::Box<double> points{group.low, group.high};
  tree.find(trees::shaft_between(points, light.box_from(points)), worker.near);
  tree.numbers_of(worker.near, worker.numbers);
  const soft::GroupTask task{groups_.pixels_of(group), frame_of(group, groups_, worker.receivers),
                             decision.candidates};
  const soft::PreparedGroup prepared = worker.preparer->prepare(frame.soft, task);
  worker.solver->solve(frame, {prepared, task.pixels, worker.numbers}, worker.found, worker.stats);
}

void SoftTint::gather(TintMask& out, TintStats& stats) const {
  std::vector<std::pair<std::uint32_t, glm::vec3>> found;
  for (const Worker& worker : workers_) {
    for (std::size_t i = 0; i < worker.found.pixels.size(); ++i)
      found.emplace_back(worker.found.pixels[i], worker.found.factors[i]);
    stats.tests += worker.stats.tests;
    stats.numeric += worker.stats.numeric;
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [pixel, factor] : found) {
    out.pixels.push_back(pixel);
    out.factors.push_back(factor);
  }
}

bool SoftTint::trace(const VisiblePoints& points, std::span<const glm::vec3> normals,
                     const TriangleView& triangles, const Panes& panes, const PaneTree& tree,
                     const AreaLight& light, const SoftMask& mask, const TintConfig& config, TintMask& out,
                     TintStats& stats, const StopFlag* stop) {
  const double tolerance = light_tolerance(light);
  const LightReach reach = reach_of(light, tolerance, triangles, panes);
  SoftShadowConfig soft_config;
  soft_config.simd = config.simd;
  grouper_.group(points, triangles, light, SoftGrouping::neighbourhood, all_, config.simd);
  choose_groups(tree, reach, mask);
  if (level_ != config.simd) workers_.clear();
  level_ = config.simd;
  workers_.resize(static_cast<std::size_t>(thread_count()));
  for (Worker& worker : workers_) {
    if (!worker.solver) {
      worker.preparer = std::make_unique<soft::GroupPreparer>(config.simd);
      worker.solver = make_soft_tint_solver(config.simd);
    }
    worker.found = {};
    worker.stats = {};
  }
  const soft::LightFrame light_frame = soft::light_frame(light);
  const soft::SoftFrame soft_frame{points, normals, triangles, light_frame, soft_config, unused_, {}, stop};
  const SoftTintFrame frame{
      soft_frame, mask, panes, reach, tolerance, config.own_irradiance, grid_side_for(config.error_255)};
  const bool done = culler_.for_each_family(groups_, triangles, light, soft_config, stop,
                                            [&](std::span<const soft::GroupDecision> family, int thread) {
                                              for (const soft::GroupDecision& decision : family)
                                                solve_group(frame, tree, reach, decision,
                                                            workers_[static_cast<std::size_t>(thread)]);
                                            });
  gather(out, stats);
  return done && !stop_requested(stop);
}

}  // namespace tenebra::tint
