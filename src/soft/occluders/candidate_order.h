// The order in which candidates stand in blocks, and are subtracted where fragments do not choose.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "soft/occluders/group_candidates.h"

namespace tenebra::soft {

/// Sorts candidates by counting, in buffers of its own.
class CandidateOrder {
public:
  /// `places` in GroupCandidates::all, in classes of size, largest first; where they are many, those of a
  /// class by where their shadows lie on the light, so that sixteen in a row lie near each other. Otherwise
  /// their order stays: neighbours in a mesh follow each other, and take the light away from one side. Valid
  /// until the next call.
  std::span<const std::uint32_t> sorted(const GroupCandidates& candidates,
                                        std::span<const std::uint32_t> places);

private:
  std::vector<std::uint32_t> ranks_, ends_, order_;
};

}  // namespace tenebra::soft
