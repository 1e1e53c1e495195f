#include "soft/family_candidates.h"

#include <algorithm>
#include <iterator>

namespace tenebra {

void FamilyCandidates::add(std::span<const std::uint32_t> triangles) {
  merged_.clear();
  std::set_union(ids_.begin(), ids_.end(), triangles.begin(), triangles.end(), std::back_inserter(merged_));
  ids_.swap(merged_);
}

std::span<const std::uint32_t> FamilyCandidates::choose(const GroupFrame& group,
                                                        std::span<const std::uint32_t> triangles,
                                                        std::span<const std::uint32_t> places,
                                                        GroupCandidates& all) {
  if (briefs_.empty()) {
    for (const Candidate& c : all.all) briefs_.push_back({c.triangle, !c.is_quad && c.sign != 0});
  }
  is_own_.assign(briefs_.size(), 0);
  auto id = triangles.begin();
  for (std::size_t i = 0; i < briefs_.size(); ++i) {
    while (id != triangles.end() && *id < briefs_[i].triangle) ++id;
    is_own_[i] = id != triangles.end() && *id == briefs_[i].triangle;
  }
  own_.clear();
  decided_.clear();
  for (const std::uint32_t place : places) {
    if (briefs_[place].is_plain) {
      if (is_own_[place] != 0) own_.push_back(place);
      continue;
    }
    Candidate& c = all.all[place];
    if (is_own_[place] == 0 && !(c.is_quad && is_own_[c.second] != 0)) continue;
    own_.push_back(place);
    if (c.sign != 0 || std::binary_search(group.receivers.begin(), group.receivers.end(), c.triangle))
      continue;
    c.sign = all.axes.turn * certain_sign(all.heights[c.height], all.axes.centre, group);
    if (c.sign != 0) decided_.push_back(place);
  }
  return own_;
}

}  // namespace tenebra
