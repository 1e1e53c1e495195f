#include <algorithm>
#include <numeric>

#include "points/sample_sides.h"
#include "soft/groups/group_parts.h"

namespace tenebra::soft {

namespace {

// Sorts by counting.
void sort_pixels(const VisiblePoints& points, std::size_t triangle_count, PixelsByTriangle& by) {
  by.ends.assign(triangle_count + 1, 0);
  for (const std::uint32_t id : points.triangles)
    if (id < triangle_count) ++by.ends[id + 1];
  std::partial_sum(by.ends.begin(), by.ends.end(), by.ends.begin());
  by.pixels.resize(by.ends.back());
  for (std::size_t i = 0; i < points.triangles.size(); ++i) {
    const std::uint32_t id = points.triangles[i];
    if (id < triangle_count) by.pixels[by.ends[id]++] = static_cast<std::uint32_t>(i);
  }
}

// The active ones of a triangle's pixels, as one group.
void append_triangle(const Grouping& g, std::span<const std::uint32_t> pixels, const LitTriangle& triangle,
                     std::vector<std::uint8_t>& set, GroupPart& part) {
  PointLanes& lanes = part.lanes;
  const std::size_t packs = (pixels.size() + 63) / 64 * 8;
  lanes.resize(8 * packs);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    lanes.put(i, g.points.positions[pixels[i]]);
    lanes.column[i] = static_cast<float>(pixels[i] % static_cast<std::uint32_t>(g.points.width));
    lanes.row[i] = static_cast<float>(pixels[i] / static_cast<std::uint32_t>(g.points.width));
  }
  set.clear();
  PointGroup group;
  group.first = part.next;
  for (std::size_t first = 0; first < pixels.size(); first += 64) {
    const std::size_t there = std::min<std::size_t>(64, pixels.size() - first);
    const std::uint64_t active =
        g.kernels.in_front(lanes, g.light, first) & (~std::uint64_t{0} >> (64 - there));
    for (const std::uint8_t byte : bytes_of(active)) set.push_back(byte);
    for (std::size_t k = 0; k < there; ++k)
      if ((active >> k & 1) != 0) g.out.pixels[part.next++] = pixels[first + k];
  }
  group.count = part.next - group.first;
  if (group.count == 0) return;
  const math::Box<double> box = g.kernels.box(lanes, set);
  group.low = box.low, group.high = box.high;
  group.cell = g.kernels.fitted_cell(lanes, set, box, g.light);
  group.first_receiver = static_cast<std::uint32_t>(part.receivers.size());
  if (triangle.receiver.triangle == free_point) {
    append_free_receivers(g, group, part.receivers);
  } else {
    const double lowest = g.kernels.lowest(lanes, set, triangle.receiver.m, g.light);
    part.receivers.push_back(receiver_of(triangle, lowest, group.cell, g.light));
  }
  group.receiver_count = static_cast<std::uint32_t>(part.receivers.size()) - group.first_receiver;
  part.groups.push_back(group);
}

/// Free points, as many to a group as to a neighbourhood.
void append_free(const Grouping& g, PixelsByTriangle& by, GroupPart& part) {
  by.one_side.clear();
  for (std::size_t i = 0; i < g.points.triangles.size(); ++i)
    if (g.points.triangles[i] == free_point) by.one_side.push_back(static_cast<std::uint32_t>(i));
  for (std::span<const std::uint32_t> rest = by.one_side; !rest.empty();) {
    const std::size_t count = std::min<std::size_t>(rest.size(), largest_neighbourhood);
    append_triangle(g, rest.first(count), lit_free_points(), by.active, part);
    rest = rest.subspan(count);
  }
}

}  // namespace

void group_by_triangle(const Grouping& g, PixelsByTriangle& by, GroupPart& part) {
  sort_pixels(g.points, g.triangles.triangles.size(), by);
  part.begin(0);
  std::uint32_t first = 0;
  for (std::uint32_t id = 0; id < g.triangles.triangles.size(); ++id) {
    const std::span<const std::uint32_t> pixels(by.pixels.data() + first, by.ends[id] - first);
    first = by.ends[id];
    if (pixels.empty()) continue;
    points::SideFinder sides(g.points, g.triangles);
    by.one_side.assign(pixels.begin(), pixels.end());
    for (std::span<std::uint32_t> rest = by.one_side; !rest.empty();) {
      const int side = sides.at(rest.front());
      const auto other = sides.differ()
                             ? std::stable_partition(rest.begin(), rest.end(),
                                                     [&](std::uint32_t p) { return sides.at(p) == side; })
                             : rest.end();
      const auto count = static_cast<std::size_t>(other - rest.begin());
      const LitTriangle triangle = lit_triangle(g.triangles, id, side, g.light);
      if (triangle.light_above) append_triangle(g, rest.first(count), triangle, by.active, part);
      rest = rest.subspan(count);
    }
  }
  append_free(g, by, part);
}

}  // namespace tenebra::soft
