#include "soft/group_tree.h"

#include <algorithm>
#include <span>

#include "soft/point_lanes.h"

namespace tenebra {

namespace {

// Halves the range along the longest side of the box of its groups' centres.
std::uint32_t split_range(std::span<PointGroup> groups) {
  PointBox box;
  for (const PointGroup& g : groups) box.add(g.low + g.high);
  const int axis = box.longest_side();
  const std::size_t half = groups.size() / 2;
  std::nth_element(groups.begin(), groups.begin() + static_cast<std::ptrdiff_t>(half), groups.end(),
                   [axis](const PointGroup& a, const PointGroup& b) {
                     return a.low[axis] + a.high[axis] < b.low[axis] + b.high[axis];
                   });
  return static_cast<std::uint32_t>(half);
}

}  // namespace

void build_group_tree(PointGroups& out) {
  out.nodes.clear();
  if (out.groups.empty()) return;
  out.nodes.reserve(2 * out.groups.size());
  out.nodes.push_back({.first = 0, .count = static_cast<std::uint32_t>(out.groups.size())});
  for (std::size_t i = 0; i < out.nodes.size(); ++i) {
    const std::uint32_t first = out.nodes[i].first, count = out.nodes[i].count;
    if (count == 1) continue;
    const std::uint32_t half = split_range({out.groups.data() + first, count});
    out.nodes[i].children = static_cast<std::uint32_t>(out.nodes.size());
    out.nodes.push_back({.first = first, .count = half});
    out.nodes.push_back({.first = first + half, .count = count - half});
  }
  for (std::size_t i = out.nodes.size(); i-- > 0;) {
    GroupNode& node = out.nodes[i];
    if (node.children == 0) {
      const PointGroup& group = out.groups[node.first];
      node.low = group.low, node.high = group.high, node.points = group.count;
      continue;
    }
    const GroupNode &a = out.nodes[node.children], &b = out.nodes[node.children + 1];
    node.low = glm::min(a.low, b.low), node.high = glm::max(a.high, b.high);
    node.points = a.points + b.points;
  }
}

}  // namespace tenebra
