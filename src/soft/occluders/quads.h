// Two neighbouring triangles that are seen as one convex quadrilateral: four lines bound its shadow, and the
// edge between them does not matter.
#pragma once

#include <cstdint>
#include <vector>

#include "soft/occluders/group_candidates.h"

namespace tenebra::soft {

/// Makes one occluder of two among `places` of `candidates` that follow each other, share an edge and, from
/// all points of the group, show the same side and form a convex quadrilateral, flat or not: its shadow is
/// that of both, exactly. Their first place stays. The two triangles of a rectangle mostly follow each other.
void pair_triangles(const GroupFrame& group, GroupCandidates& candidates, std::vector<std::uint32_t>& places);

}  // namespace tenebra::soft
