// The tree of boxes above the groups.
#pragma once

#include "soft/point_groups.h"

namespace tenebra {

/// Sorts out.groups so that those of each node follow each other, and makes out.nodes: ranges are halved
/// along the longest side of the box of their groups' centres.
void build_group_tree(PointGroups& out);

}  // namespace tenebra
