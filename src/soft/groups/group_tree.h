// The tree of boxes above the groups.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "soft/groups/point_groups.h"

namespace tenebra::soft {

/// A group, wherever it is stored, and roughly where its points are.
struct GroupKey {
  glm::vec3 centre{0.0f};
  const PointGroup* group = nullptr;
};

/// Fills out.groups with the groups so that those of each node follow each other, and makes out.nodes: ranges
/// are halved along the longest side of the box of their groups' centres. Sorts the keys.
void build_group_tree(std::span<GroupKey> keys, PointGroups& out);

}  // namespace tenebra::soft
