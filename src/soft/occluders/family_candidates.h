// The candidates of groups that lie near each other, prepared once, and which of them belong to each group.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "soft/occluders/group_candidates.h"

namespace tenebra::soft {

class FamilyCandidates {
public:
  static constexpr std::size_t most_groups = 32;

  /// Begins another family.
  void clear();
  /// Adds a group's triangles, ascending: first those of group 0, then of group 1, up to most_groups - 1.
  void add(std::span<const std::uint32_t> triangles);
  /// All of them, ascending.
  std::span<const std::uint32_t> triangles() const { return ids_; }

  /// The candidates made from all of them, and the places that groups choose from.
  void make_ready(const GroupCandidates& all, std::span<const std::uint32_t> places);

  /// Those of the places that hold one of the triangles of group `k`, which is `group`; a quad belongs to it
  /// by either of its two. Signs that differ among the points of the family, but not among those of the
  /// group, are set in `all` until restore(). Of no use if `stop` was requested.
  std::span<const std::uint32_t> choose(std::size_t k, const GroupFrame& group, GroupCandidates& all,
                                        const StopFlag* stop = nullptr);
  void restore(GroupCandidates& all) const {
    for (const std::uint32_t place : decided_) all.all[place].sign = 0;
  }

private:
  struct Member {
    std::uint32_t place;
    std::uint32_t groups;  ///< bits of those that have it
  };

  std::size_t count_ = 0;                       ///< of groups
  std::vector<std::uint32_t> ids_, groups_;     ///< triangles, and bits of the groups of each
  std::vector<std::uint32_t> merged_, joined_;  ///< scratch: the next of these
  std::vector<Member> members_, doubtful_;      ///< all, in the order of the places, and those without a sign
  std::vector<std::uint32_t> own_, decided_;    ///< places
};

}  // namespace tenebra::soft
