// From the points of one group and the occluders in its shaft to visible fractions and irradiance.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <tenebra/frame_timings.h>
#include <tenebra/soft_config.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include "soft/bsp/group_occluders.h"
#include "soft/light/light_frame.h"

namespace tenebra::soft {

/// What all groups of a frame and light share.
struct SoftFrame {
  const VisiblePoints& points;
  std::span<const glm::vec3> normals;  ///< one a pixel, or empty
  const ViewRays& view;
  const TriangleView& triangles;
  const LightFrame& light;
  const SoftShadowConfig& config;
  SoftMask& out;
  std::span<std::uint8_t> classes;
  const StopFlag* stop;  ///< looked at for each point that needs a solver of its own; may be null
};

/// Points of one group, and what may stand between them and the light.
struct GroupTask {
  std::span<const std::uint32_t> pixels;
  GroupFrame frame;
  std::span<const std::uint32_t> candidates;  ///< triangles, ascending; all that block are among them
};

/// Times of one thread, milliseconds.
struct SolverTimes {
  double init_ms = 0, query_ms = 0, irradiance_ms = 0;
};

/// Solves group after group with buffers of its own: one a thread.
class GroupSolver {
public:
  virtual ~GroupSolver() = default;

  /// Fills out's pixels of the group, some of them if frame.stop was requested. The result depends on the
  /// group alone.
  virtual void solve(const SoftFrame& frame, const GroupTask& task) = 0;
  /// The same for groups that lie near each other, within `around`, and have many candidates: these are made
  /// ready once for all.
  virtual void solve_together(const SoftFrame& frame, const GroupFrame& around,
                              std::span<const GroupTask> tasks) = 0;
  /// The same for groups that nothing stands in front of.
  virtual void solve_lit(const SoftFrame& frame, std::span<const std::span<const std::uint32_t>> groups) = 0;

  /// Asks memory for the points of the group that is likely solved next (of many, the first), and for the
  /// list of those `after` it.
  virtual void expect(const SoftFrame& frame, std::span<const std::uint32_t> pixels,
                      std::span<const std::uint32_t> after) const = 0;

  SoftStats stats;
  SolverTimes times;
};

std::unique_ptr<GroupSolver> make_group_solver(SimdLevel level);

}  // namespace tenebra::soft
