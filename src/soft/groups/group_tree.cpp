#include "soft/groups/group_tree.h"

#include <algorithm>
#include <span>

#include "parallel/parallel.h"
#include "soft/groups/point_lanes.h"

namespace tenebra::soft {

namespace {

// Ranges of at most this many groups are split by one thread.
constexpr std::uint32_t serial_groups = 1024;

// Splits ranges of keys, and makes the nodes of the tree: a range of n groups has 2 n - 1. After the first
// node come its two children, then what is below the one child, then what is below the other.
class TreeBuilder {
public:
  TreeBuilder(std::span<GroupKey> keys, PointGroups& out) : keys_(keys), out_(out) {}

  /// `place`: where the nodes below the node begin.
  void build(std::uint32_t index, std::uint32_t first, std::uint32_t count, std::uint32_t place) {
    GroupNode& node = out_.nodes[index];
    node = {};
    node.first = first, node.count = count;
    if (count == 1) {
      take(node, keys_[first].group);
      return;
    }
    const std::uint32_t half = split(keys_.subspan(first, count));
    node.children = place;
    const auto child = [&](int k) {
      if (k == 0) build(place, first, half, place + 2);
      if (k == 1) build(place + 1, first + half, count - half, place + 2 * half);
    };
    if (count > serial_groups) {
      parallel::parallel_tasks(2, child);
    } else {
      child(0), child(1);
    }
    const GroupNode &a = out_.nodes[place], &b = out_.nodes[place + 1];
    node.low = glm::min(a.low, b.low), node.high = glm::max(a.high, b.high);
    node.points = a.points + b.points;
  }

private:
  // Halves a range along the longest side of the box of its groups' centres.
  static std::uint32_t split(std::span<GroupKey> keys) {
    glm::vec3 low = keys[0].centre, high = low;
    for (const GroupKey& key : keys) low = glm::min(low, key.centre), high = glm::max(high, key.centre);
    const int axis = math::Box<double>{low, high}.longest_side();
    const std::size_t half = keys.size() / 2;
    std::nth_element(
        keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(half), keys.end(),
        [axis](const GroupKey& a, const GroupKey& b) { return a.centre[axis] < b.centre[axis]; });
    return static_cast<std::uint32_t>(half);
  }

  void take(GroupNode& node, const PointGroup* group) {
    out_.groups[node.first] = *group;
    node.low = group->low, node.high = group->high, node.points = group->count;
  }

  std::span<GroupKey> keys_;
  PointGroups& out_;
};

}  // namespace

void build_group_tree(std::span<GroupKey> keys, PointGroups& out) {
  const auto count = static_cast<std::uint32_t>(keys.size());
  out.groups.resize(count);
  out.nodes.resize(count == 0 ? 0 : 2 * count - 1);
  if (count > 0) TreeBuilder(keys, out).build(0, 0, count, 1);
}

}  // namespace tenebra::soft
