#include "soft/groups/point_groups.h"

#include <span>
#include <vector>

#include "parallel/parallel.h"
#include "soft/groups/group_parts.h"
#include "soft/groups/group_tree.h"

namespace tenebra::soft {

namespace {

// Takes over the groups of all parts, in the order of the tree.
void join(std::span<GroupPart> parts, PointGroups& out) {
  std::size_t groups = 0, receivers = 0;
  for (const GroupPart& part : parts) groups += part.groups.size(), receivers += part.receivers.size();
  std::vector<GroupKey> keys;
  keys.reserve(groups);
  out.receivers.reserve(receivers);
  for (GroupPart& part : parts) {
    const auto first_receiver = static_cast<std::uint32_t>(out.receivers.size());
    for (PointGroup& group : part.groups) {
      group.first_receiver += first_receiver;
      keys.push_back({glm::vec3(0.5 * (group.low + group.high)), &group});
    }
    out.receivers.insert(out.receivers.end(), part.receivers.begin(), part.receivers.end());
  }
  build_group_tree(keys, out);
}

}  // namespace

void group_points(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                  const AreaLight& light, SoftGrouping grouping, PointGroups& out, SimdLevel simd) {
  const parallel::FloatEnvironment ieee;
  out.width = points.width;
  out.receivers.clear();
  out.pixels.resize(points.triangles.size());
  const Grouping g{points, view, triangles, LightShape(light), point_kernels(simd), out};
  if (grouping == SoftGrouping::triangle) {
    GroupPart part = group_by_triangle(g);
    join({&part, 1}, out);
  } else {
    std::vector<GroupPart> parts = group_tiles(g);
    join(parts, out);
  }
}

}  // namespace tenebra::soft
