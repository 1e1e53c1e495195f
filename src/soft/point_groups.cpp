#include "soft/point_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "math/predicates.h"
#include "parallel/parallel.h"
#include "points/triangle_corners.h"
#include "soft/group_tree.h"

namespace tenebra {

namespace {

using glm::dvec3;

constexpr std::uint32_t tile = 8;  // pixels a side
static_assert(tile * tile == largest_neighbourhood);

double sum(const dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

// Pixels of a tile along a Z curve, so that any range of them lies together.
struct Offset {
  std::uint32_t x, y;
};
constexpr auto z_curve = [] {
  std::array<Offset, largest_neighbourhood> offsets{};
  for (std::uint32_t z = 0; z < offsets.size(); ++z)
    offsets[z] = {(z & 1) | (z >> 1 & 2) | (z >> 2 & 4), (z >> 1 & 1) | (z >> 2 & 2) | (z >> 3 & 4)};
  return offsets;
}();

// What decides whether the points of one triangle are active.
struct Reach {
  Receiver receiver;
  bool light_above = false;  // a part of the light may be on the seen side of the plane
};

Reach reach_of(const TriangleView& triangles, std::uint32_t id, const ViewRays& view,
               const AreaLight& light) {
  Reach reach{{id, seen_side(triangles, id, view)}};
  if (reach.receiver.side == 0) return reach;
  const Corners c = corners_of(triangles, id);
  const dvec3 a(c.v[0]), e1 = dvec3(c.v[1]) - a, e2 = dvec3(c.v[2]) - a;
  const dvec3 n = glm::cross(e1, e2) * static_cast<double>(reach.receiver.side);
  for (const glm::dvec2& v : light.outline) {
    const dvec3 q = light.centre + v.x * light.ex + v.y * light.ey;
    // Q is off by 2^-50 of its coordinates, n and the dot product as in predicates.cpp.
    const double bound = 0x1p-46 * sum(e1) * sum(e2) * (sum(q - a) + sum(light.centre) + sum(q));
    reach.light_above |= glm::dot(n, q - a) > -bound;
  }
  return reach;
}

// Answers for the pixels of a frame, and remembers triangles.
class ActivePoints {
public:
  ActivePoints(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
               const AreaLight& light)
      : points_(points), view_(view), triangles_(triangles), light_(light), light_size_(sum(light.centre)) {}

  /// The pixel's receiver, if the point is active.
  const Receiver* receiver(std::uint32_t pixel) {
    const std::uint32_t id = points_.triangles[pixel];
    if (id >= triangles_.triangles.size()) return nullptr;
    Reach& reach = known_[id % known_.size()];
    if (id != reach.receiver.triangle) reach = reach_of(triangles_, id, view_, light_);
    return reach.light_above && in_front(points_.positions[pixel]) ? &reach.receiver : nullptr;
  }
  const dvec3& position(std::uint32_t pixel) const { return points_.positions[pixel]; }

private:
  bool in_front(const dvec3& p) const {
    return glm::dot(p - light_.centre, light_.normal) > -0x1p-48 * (sum(p) + light_size_);
  }

  const VisiblePoints& points_;
  const ViewRays& view_;
  const TriangleView& triangles_;
  const AreaLight& light_;
  double light_size_;
  std::array<Reach, 64> known_;  // by the id's last bits
};

struct Point {
  std::uint32_t pixel;
  Receiver receiver;
};

// Groups of a part of the picture; its points go where the caller says.
struct Part {
  std::vector<PointGroup> groups;
  std::vector<Receiver> receivers;
  std::uint32_t next = 0;  // place of the next point in PointGroups
};

void append_group(std::span<const Point> points, const PointBox& box, Part& part, PointGroups& out) {
  PointGroup group;
  group.first = part.next;
  group.count = static_cast<std::uint32_t>(points.size());
  group.first_receiver = static_cast<std::uint32_t>(part.receivers.size());
  group.low = box.low, group.high = box.high;
  for (const Point& p : points) {
    out.pixels[part.next++] = p.pixel;
    if (part.receivers.size() == group.first_receiver ||
        part.receivers.back().triangle != p.receiver.triangle)
      part.receivers.push_back(p.receiver);
  }
  const auto begin = part.receivers.begin() + group.first_receiver;
  std::sort(begin, part.receivers.end(), [](auto& a, auto& b) { return a.triangle < b.triangle; });
  part.receivers.erase(
      std::unique(begin, part.receivers.end(), [](auto& a, auto& b) { return a.triangle == b.triangle; }),
      part.receivers.end());
  group.receiver_count = static_cast<std::uint32_t>(part.receivers.size()) - group.first_receiver;
  part.groups.push_back(group);
}

// Splits where five of sixteen slices across the longest side are empty: rows of pixels evenly spaced along
// it leave at most two, so this is a gap in depth.
constexpr int slices = 16;
constexpr int slices_of_a_gap = 5;

void append_split(const ActivePoints& active, std::span<Point> points, Part& part, PointGroups& out) {
  PointBox box;
  for (const Point& p : points) box.add(active.position(p.pixel));
  const int axis = box.longest_side();
  const double scale = slices / (box.high[axis] - box.low[axis]);
  const auto slice = [&](const Point& p) {
    return std::min(slices - 1, static_cast<int>((active.position(p.pixel)[axis] - box.low[axis]) * scale));
  };
  int gap = 0, run = 0;
  if (std::isfinite(scale)) {
    std::uint32_t taken = 0;
    for (const Point& p : points) taken |= 1u << slice(p);
    for (int k = 0; k < slices && gap == 0; ++k) {
      run = (taken >> k & 1) != 0 ? 0 : run + 1;
      if (run == slices_of_a_gap) gap = k;
    }
  }
  if (gap == 0) {
    append_group(points, box, part, out);
    return;
  }
  const auto middle =
      std::stable_partition(points.begin(), points.end(), [&](const Point& p) { return slice(p) < gap; });
  append_split(active, {points.begin(), middle}, part, out);
  append_split(active, {middle, points.end()}, part, out);
}

// Pixels by triangle, each triangle's in row order (counting sort).
std::vector<std::uint32_t> pixels_by_triangle(const VisiblePoints& points, std::size_t triangle_count) {
  std::vector<std::uint32_t> next(triangle_count + 1, 0);
  for (const std::uint32_t id : points.triangles)
    if (id < triangle_count) ++next[id + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<std::uint32_t> pixels(next.back());
  for (std::size_t i = 0; i < points.triangles.size(); ++i) {
    const std::uint32_t id = points.triangles[i];
    if (id < triangle_count) pixels[next[id]++] = static_cast<std::uint32_t>(i);
  }
  return pixels;
}

void append(const Part& part, PointGroups& to) {
  const auto first_receiver = static_cast<std::uint32_t>(to.receivers.size());
  for (PointGroup group : part.groups) {
    group.first_receiver += first_receiver;
    to.groups.push_back(group);
  }
  to.receivers.insert(to.receivers.end(), part.receivers.begin(), part.receivers.end());
}

void group_by_triangle(std::span<const std::uint32_t> pixels, ActivePoints& active, PointGroups& out) {
  Part part;
  std::vector<Point> taken;
  PointBox box;
  const auto close = [&] {
    if (!taken.empty()) append_group(taken, box, part, out);
    taken.clear();
    box = {};
  };
  for (const std::uint32_t pixel : pixels) {
    const Receiver* receiver = active.receiver(pixel);
    if (receiver == nullptr) continue;
    if (!taken.empty() && taken.back().receiver.triangle != receiver->triangle) close();
    taken.push_back({pixel, *receiver});
    box.add(active.position(pixel));
  }
  close();
  append(part, out);
}

// Rows of tiles run in parallel; each has room for all of its pixels.
void group_tiles(const VisiblePoints& points, auto&& make_active, PointGroups& out) {
  const auto width = static_cast<std::uint32_t>(points.width);
  const auto height = static_cast<std::uint32_t>(points.height);
  std::vector<Part> parts((height + tile - 1) / tile);
  parallel_tasks(static_cast<int>(parts.size()), [&](int row) {
    ActivePoints active = make_active();
    Part& part = parts[row];
    const std::uint32_t top = static_cast<std::uint32_t>(row) * tile;
    part.next = top * width;
    std::array<Point, largest_neighbourhood> taken;
    for (std::uint32_t left = 0; left < width; left += tile) {
      std::size_t count = 0;
      for (const Offset o : z_curve) {
        if (left + o.x >= width || top + o.y >= height) continue;
        const std::uint32_t pixel = (top + o.y) * width + left + o.x;
        if (const Receiver* receiver = active.receiver(pixel)) taken[count++] = {pixel, *receiver};
      }
      if (count > 0) append_split(active, {taken.data(), count}, part, out);
    }
  });
  for (const Part& part : parts) append(part, out);
}

}  // namespace

int seen_side(const TriangleView& triangles, std::uint32_t id, const ViewRays& view) {
  const Corners c = corners_of(triangles, id);
  return view.orthographic ? -direction_side(c.v[0], c.v[1], c.v[2], view.d0)
                           : point_side(c.v[0], c.v[1], c.v[2], view.eye);
}

void group_points(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                  const AreaLight& light, SoftGrouping grouping, PointGroups& out) {
  const FloatEnvironment ieee;
  out.points = &points;
  out.width = points.width;
  out.groups.clear();
  out.receivers.clear();
  out.pixels.resize(points.triangles.size());
  if (grouping == SoftGrouping::triangle) {
    ActivePoints active(points, view, triangles, light);
    group_by_triangle(pixels_by_triangle(points, triangles.triangles.size()), active, out);
  } else {
    group_tiles(
        points, [&] { return ActivePoints(points, view, triangles, light); }, out);
  }
  build_group_tree(out);
}

}  // namespace tenebra
