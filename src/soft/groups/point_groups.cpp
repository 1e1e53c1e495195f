#include "soft/groups/point_groups.h"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"
#include "soft/groups/group_parts.h"
#include "soft/groups/group_tree.h"

namespace tenebra::soft {

namespace {

// Takes over the groups of all parts, in the order of the tree.
void join(std::span<GroupPart> parts, std::vector<GroupKey>& keys, PointGroups& out) {
  std::size_t groups = 0, receivers = 0;
  for (const GroupPart& part : parts) groups += part.groups.size(), receivers += part.receivers.size();
  keys.clear();
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

void append_free_receivers(const Grouping& g, const PointGroup& group, std::vector<Receiver>& out) {
  Receiver least = receiver_of(lit_free_points(), 0, group.cell, g.light), most = least;
  least.tau = std::numeric_limits<double>::infinity();
  for (const std::uint32_t pixel : g.out.pixels_of(group)) {
    if (g.points.triangles[pixel] != free_point) continue;
    const double tau = points::own_tolerance(g.triangles, free_point, g.points.positions[pixel]);
    least.tau = std::min(least.tau, tau), most.tau = std::max(most.tau, tau);
  }
  out.push_back(least), out.push_back(most);
}

struct PointGrouper::State {
  std::vector<GroupPart> parts;
  std::vector<GroupKey> keys;
  PixelsByTriangle by_triangle;
};

PointGrouper::PointGrouper() : state_(std::make_unique<State>()) {}
PointGrouper::PointGrouper(PointGrouper&&) noexcept = default;
PointGrouper& PointGrouper::operator=(PointGrouper&&) noexcept = default;
PointGrouper::~PointGrouper() = default;

void PointGrouper::group(const VisiblePoints& points, const TriangleView& triangles, const AreaLight& light,
                         SoftGrouping grouping, PointGroups& out, SimdLevel simd) {
  State& s = *state_;
  const parallel::FloatEnvironment ieee;
  out.width = points.width;
  out.receivers.clear();
  out.pixels.resize(points.triangles.size());
  const Grouping g{points, triangles, LightShape(light), point_kernels(simd), out};
  if (grouping == SoftGrouping::triangle) {
    if (s.parts.empty()) s.parts.resize(1);
    group_by_triangle(g, s.by_triangle, s.parts[0]);
    join({&s.parts[0], 1}, s.keys, out);
  } else {
    join(group_tiles(g, s.parts), s.keys, out);
  }
}

void group_points(const VisiblePoints& points, const TriangleView& triangles, const AreaLight& light,
                  SoftGrouping grouping, PointGroups& out, SimdLevel simd) {
  PointGrouper().group(points, triangles, light, grouping, out, simd);
}

}  // namespace tenebra::soft
