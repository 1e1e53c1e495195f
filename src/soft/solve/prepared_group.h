// Groups made ready for the solvers: their candidates, sorted into the silhouette of meshes and what is
// clipped.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "soft/occluders/candidate_order.h"
#include "soft/occluders/family_candidates.h"
#include "soft/silhouette/group_silhouette.h"
#include "soft/solve/soft_frame.h"

namespace tenebra::soft {

/// A group that the solvers can begin with.
struct PreparedGroup {
  const GroupFrame& frame;
  const GroupCandidates& candidates;
  const GroupSilhouette& silhouette;       ///< empty where no meshes are worth one
  std::span<const std::uint32_t> clipped;  ///< places of the candidates that are clipped, largest first
  std::size_t tree_bytes = 0;              ///< what its BSP may take
};

/// Prepares one group after the other in buffers of its own.
class GroupPreparer {
public:
  explicit GroupPreparer(SimdLevel level) : find_candidates_(find_candidates_kernel(level)) {}

  /// Valid until the next call, like all that is returned here. Of no use if frame.stop was requested.
  PreparedGroup prepare(const SoftFrame& frame, const GroupTask& task);

  /// Begins with groups that lie near each other: returns how many triangles they have together.
  std::size_t begin_family(std::span<const GroupTask> tasks);
  /// Prepares these groups, which lie within `around`, at once. False where their meshes have a
  /// silhouette: then each is better off with one of its own, by prepare(). Of no use if frame.stop was
  /// requested.
  bool prepare_family(const SoftFrame& frame, const GroupFrame& around);
  /// Group `k` of the family, until restore(). Of no use if `stop` was requested.
  PreparedGroup choose(std::size_t k, const GroupTask& task, const StopFlag* stop);
  void restore() { family_.restore(candidates_); }

private:
  std::span<const std::uint32_t> sort_out(const SoftFrame& frame, const GroupFrame& group,
                                          std::span<const std::uint32_t> triangles);

  FindCandidates find_candidates_;
  GroupCandidates candidates_;
  SilhouetteFinder finder_;
  GroupSilhouette silhouette_;
  std::vector<std::uint32_t> rest_;  ///< places of the candidates that the silhouette leaves
  CandidateOrder order_;
  FamilyCandidates family_;
};

/// No tree takes more than this, whatever SoftShadowConfig::tree_bytes says: nodes and pending lists have
/// indices of 31 bits.
inline constexpr std::size_t largest_tree_bytes = std::size_t{1} << 30;

/// The places of all candidates.
void take_all(const GroupCandidates& candidates, std::vector<std::uint32_t>& places);

}  // namespace tenebra::soft
