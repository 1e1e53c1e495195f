// Shaft culling: of all casting triangles those that may block a line from a group of points to the light
// (Haines 2000, "A shaft culling tool"; Mora et al. 2012, "Implementation details"), filtered on the way down
// a tree of the groups. Conservative: a triangle that blocks a line is never dropped.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include <tenebra/stop_flag.h>
#include "soft/groups/point_groups.h"

namespace tenebra::soft {

enum class GroupClass : std::uint8_t {
  lit,    ///< nothing can block a line from the group to the light
  dark,   ///< one triangle blocks every line from every point to every point of the light: certain
  mixed,  ///< anything else: a solver decides
};

/// What is to be done with a group. `candidates`: ids of the triangles that may block, in an order that does
/// not depend on threads (lit: none; dark: the triangle that blocks all).
struct GroupDecision {
  const PointGroup* group;
  GroupClass kind;
  std::span<const std::uint32_t> candidates;
  /// How many of them may block a line from the middle of the group: counted where the configuration allows
  /// an error and there are many, else 0.
  std::uint32_t from_middle = 0;
};

/// Takes groups that lie near each other, a family; which they are does not depend on threads. `thread`:
/// 0..thread_count() - 1, for scratch; no other body runs with the same one meanwhile, as long as the body
/// starts no parallel loop.
using FamilyBody = std::function<void(std::span<const GroupDecision> family, int thread)>;
inline constexpr std::uint32_t largest_family = 12;  ///< groups, unless nothing can stand in front of them

/// Counts do not depend on threads.
struct ShaftStats {
  std::uint64_t groups_lit = 0, groups_dark = 0, groups_mixed = 0;
  std::uint64_t points_lit = 0, points_dark = 0, points_mixed = 0;
  std::uint64_t candidates = 0;       ///< of mixed groups, summed
  std::uint64_t most_candidates = 0;  ///< of one group
  double seconds = 0;                 ///< spent here, without the bodies: all threads' time, summed
};

/// Buffers kept from frame to frame.
class ShaftCuller {
public:
  ShaftCuller();
  ShaftCuller(ShaftCuller&&) noexcept;
  ShaftCuller& operator=(ShaftCuller&&) noexcept;
  ~ShaftCuller();

  /// Calls `body` once for each family, in parallel, those with most points times candidates first as far as
  /// memory allows. A triangle is left out of a group's candidates only if it is certain that it blocks no
  /// line from a point of the group to the light, by the rule of SoftShadowTracer::trace; which of the others
  /// are left out depends neither on threads nor on the instruction set. `chosen`: numbers of groups,
  /// ascending; families hold only these, which get the candidates that they get among all. Returns false,
  /// with some families left out, if `stop` was requested.
  bool for_each_family(const PointGroups& groups, const TriangleView& triangles, const AreaLight& light,
                       const SoftShadowConfig& config, const StopFlag* stop, const FamilyBody& body,
                       std::optional<std::span<const std::uint32_t>> chosen = {});

  const ShaftStats& stats() const;  ///< of the last call

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tenebra::soft
