// The tree of boxes above the groups.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "soft/point_groups.h"

namespace tenebra {

struct PointBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  /// 0, 1 or 2; the first of equals.
  int longest_side() const {
    const glm::dvec3 size = high - low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  }
};

/// Sorts out.groups so that those of each node follow each other, and makes out.nodes: ranges are halved
/// along the longest side of the box of their groups' centres.
void build_group_tree(PointGroups& out);

}  // namespace tenebra
