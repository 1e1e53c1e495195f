// Area lights: the share of the irradiance that see-through triangles let pass.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <tenebra/tint.h>
#include "soft/shafts/shafts.h"
#include "soft/solve/prepared_group.h"
#include "tint/pane_tree.h"
#include "tint/panes.h"

namespace tenebra::tint {

/// Where a light is, as far as boxes tell.
struct LightReach {
  math::Box<double> box;  ///< holds the light; of a sun its directions
  bool at_infinity = false;
  double farthest = 0;  ///< largest |coordinate| of the see-through triangles

  /// Holds the light, or as much of a sun's rays from `from` that what is see-through lies before their ends.
  math::Box<double> box_from(const math::Box<double>& from) const;
};

/// What all groups of a light share.
struct SoftTintFrame {
  const soft::SoftFrame& soft;  ///< opaque casters; its `out` is not written
  const SoftMask& mask;
  const Panes& panes;
  LightReach reach;
  double plane_tolerance = 0;  ///< metres off the light's plane that its own rounding amounts to
  bool own_irradiance = false;
  int grid_side = 0;  ///< grid_side_for()
};

/// Points of one group, and what may stand between them and the light.
struct SoftTintTask {
  const soft::PreparedGroup& group;
  std::span<const std::uint32_t> pixels;
  std::span<const std::uint32_t> numbers;  ///< of the see-through triangles, in Panes
};

/// Triangles before a point from which on places are counted instead of pieces cut.
inline constexpr std::size_t most_cut = 24;

/// Triangles before a group that are set up once for all of its points, 4.5 MB for each thread; of more,
/// parts are set up anew for each point.
inline constexpr std::size_t most_set_up = 1 << 15;

/// Boxes of shadows on the light are widened by this, in units of the light, as their corners are rounded;
/// one that is off by more, seen along the light's plane, loses a strip of the shadow no wider than that.
inline constexpr double box_slack = 1e-5;

/// Cells along each side of the light's grid, with a place in each, for an error of irradiance that is
/// allowed, in 1/255 of white. One edge of a black shadow across the light puts a factor off by 0.5 side^-1.5
/// (RMS): some 1.2 `side` cells are cut, and of each up to half is miscounted, independently of the others.
/// That may be half of the error.
int grid_side_for(double error_255);

/// Buffers kept from group to group.
class SoftTintSolver {
public:
  virtual ~SoftTintSolver() = default;
  /// Appends to `found` what is not 1.
  virtual void solve(const SoftTintFrame& frame, const SoftTintTask& task, TintMask& found,
                     TintStats& stats) = 0;
};
std::unique_ptr<SoftTintSolver> make_soft_tint_solver(SimdLevel level);

/// Buffers kept from frame to frame.
class SoftTint {
public:
  /// TintTracer::trace for an area light. False if it was stopped.
  bool trace(const VisiblePoints& points, std::span<const glm::vec3> normals, const TriangleView& triangles,
             const Panes& panes, const PaneTree& tree, const AreaLight& light, const SoftMask& mask,
             const TintConfig& config, TintMask& out, TintStats& stats, const StopFlag* stop);

private:
  struct Worker {
    std::unique_ptr<soft::GroupPreparer> preparer;
    std::unique_ptr<SoftTintSolver> solver;
    std::vector<trees::BlockTriangles> near;
    std::vector<std::uint32_t> numbers, receivers;
    TintMask found;
    TintStats stats;
  };
  void choose_groups(const PaneTree& tree, const LightReach& light, const SoftMask& mask);
  void solve_group(const SoftTintFrame& frame, const PaneTree& tree, const LightReach& light,
                   const soft::GroupDecision& decision, Worker& worker);
  void gather(TintMask& out, TintStats& stats) const;

  soft::PointGrouper grouper_;
  soft::PointGroups all_, groups_;  ///< groups_: those that may see the light through something
  soft::ShaftCuller culler_;
  std::vector<Worker> workers_;
  SimdLevel level_ = SimdLevel::automatic;
  SoftMask unused_;
};

}  // namespace tenebra::tint
