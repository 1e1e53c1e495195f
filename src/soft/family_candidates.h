// The candidates of groups that lie near each other, made ready once, and which of them are those of one
// group.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "soft/group_candidates.h"

namespace tenebra {

class FamilyCandidates {
public:
  /// Takes up another family.
  void clear() {
    ids_.clear();
    briefs_.clear();
  }
  /// Adds a group's triangles, ascending.
  void add(std::span<const std::uint32_t> triangles);
  /// All of them, ascending.
  std::span<const std::uint32_t> triangles() const { return ids_; }

  /// Those of `places` in `all` that hold one of `triangles`, a pair with either of its two. Signs that
  /// depend on the points of the family, but not on those of `group`, are set until restore(). `all` is the
  /// same for all groups of a family.
  std::span<const std::uint32_t> choose(const GroupFrame& group, std::span<const std::uint32_t> triangles,
                                        std::span<const std::uint32_t> places, GroupCandidates& all);
  void restore(GroupCandidates& all) const {
    for (const std::uint32_t place : decided_) all.all[place].sign = 0;
  }

private:
  /// What is asked of all candidates for each group, close together.
  struct Brief {
    std::uint32_t triangle;
    bool is_plain;  ///< no pair, and of a certain sign
  };

  std::vector<std::uint32_t> ids_, merged_;
  std::vector<Brief> briefs_;                 ///< of each candidate
  std::vector<std::uint8_t> is_own_;          ///< of each candidate
  std::vector<std::uint32_t> own_, decided_;  ///< places
};

}  // namespace tenebra
