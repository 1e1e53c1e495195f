#include "soft/occluders/family_candidates.h"

#include <algorithm>

#include "base/until_stopped.h"

namespace tenebra::soft {

void FamilyCandidates::clear() {
  count_ = 0;
  ids_.clear();
  groups_.clear();
}

void FamilyCandidates::add(std::span<const std::uint32_t> triangles) {
  const std::uint32_t bit = 1u << count_++;
  merged_.clear();
  joined_.clear();
  auto next = triangles.begin();
  const auto take = [&](std::uint32_t id, std::uint32_t groups) {
    merged_.push_back(id);
    joined_.push_back(groups);
  };
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    for (; next != triangles.end() && *next < ids_[i]; ++next) take(*next, bit);
    const bool both = next != triangles.end() && *next == ids_[i];
    if (both) ++next;
    take(ids_[i], groups_[i] | (both ? bit : 0));
  }
  for (; next != triangles.end(); ++next) take(*next, bit);
  ids_.swap(merged_);
  groups_.swap(joined_);
}

void FamilyCandidates::make_ready(const GroupCandidates& all, std::span<const std::uint32_t> places) {
  std::vector<std::uint32_t>& groups = joined_;  // of each candidate
  groups.clear();
  std::size_t i = 0;
  for (const Candidate& c : all.all) {
    while (i < ids_.size() && ids_[i] < c.triangle) ++i;
    groups.push_back(i < ids_.size() && ids_[i] == c.triangle ? groups_[i] : 0);
  }
  members_.clear();
  doubtful_.clear();
  for (const std::uint32_t place : places) {
    const Candidate& c = all.all[place];
    members_.push_back({place, groups[place] | (c.is_quad ? groups[c.second] : 0)});
    if (c.sign == 0) doubtful_.push_back(members_.back());
  }
}

std::span<const std::uint32_t> FamilyCandidates::choose(std::size_t k, const GroupFrame& group,
                                                        GroupCandidates& all, const StopFlag* stop) {
  own_.resize(members_.size());
  std::size_t count = 0;
  for (const Member& member : members_) {
    own_[count] = member.place;
    count += member.groups >> k & 1u;
  }
  decided_.clear();
  base::each_until_stopped(0, doubtful_.size(), stop, [&](std::size_t i) {
    const Member& member = doubtful_[i];
    if ((member.groups >> k & 1u) == 0) return;
    Candidate& c = all.all[member.place];
    if (std::binary_search(group.receivers.begin(), group.receivers.end(), c.triangle)) return;
    c.sign = all.axes.turn * certain_sign(all.heights[c.height], all.axes.centre, group);
    if (c.sign != 0) decided_.push_back(member.place);
  });
  return {own_.data(), count};
}

}  // namespace tenebra::soft
