#include "soft/point_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "math/predicates.h"
#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::dvec3;

constexpr std::uint32_t tile = 8;  // pixels a side

double length_of(const dvec3& v) {
  return std::sqrt(glm::dot(v, v));
}

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
    const double bound = 0x1p-46 * length_of(e1) * length_of(e2) * (length_of(q - a) + length_of(q));
    reach.light_above |= glm::dot(n, q - a) > -bound;
  }
  return reach;
}

bool in_front(const dvec3& p, const AreaLight& light) {
  const double bound = 0x1p-48 * (length_of(p) + length_of(light.centre));
  return glm::dot(p - light.centre, light.normal) > -bound;
}

// A growing set of groups with the triangle last asked about.
class Grouper {
public:
  Grouper(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
          const AreaLight& light, PointGroups& out)
      : points_(points), view_(view), triangles_(triangles), light_(light), out_(out) {}

  /// Appends the pixel if it is active.
  void take(std::uint32_t pixel) {
    const std::uint32_t id = points_.triangles[pixel];
    if (id >= triangles_.triangles.size()) return;
    if (id != reach_.receiver.triangle) reach_ = reach_of(triangles_, id, view_, light_);
    if (!reach_.light_above || !in_front(points_.positions[pixel], light_)) return;
    taken_.push_back({pixel, reach_.receiver});
  }

  /// Makes groups of the pixels taken since.
  void close() {
    if (!taken_.empty()) split(taken_);
    taken_.clear();
  }
  void close_whole() {
    if (!taken_.empty()) append(taken_);
    taken_.clear();
  }

private:
  struct Taken {
    std::uint32_t pixel;
    Receiver receiver;
  };

  const dvec3& at(const Taken& t) const { return points_.positions[t.pixel]; }

  // Splits at the widest gap along the longest side of the box while that gap is wide for the box.
  void split(std::span<Taken> part) {
    dvec3 low(INFINITY), high(-INFINITY);
    for (const Taken& t : part) low = glm::min(low, at(t)), high = glm::max(high, at(t));
    const dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::array<double, largest_neighbourhood> along;
    for (std::size_t i = 0; i < part.size(); ++i) along[i] = at(part[i])[axis];
    std::sort(along.begin(), along.begin() + part.size());
    std::size_t widest = 0;
    for (std::size_t i = 1; i < part.size(); ++i)
      if (widest == 0 || along[i] - along[i - 1] > along[widest] - along[widest - 1]) widest = i;
    if (widest == 0 || !(along[widest] - along[widest - 1] > gap_share * size[axis])) {
      append(part);
      return;
    }
    const double limit = along[widest];
    const auto middle =
        std::stable_partition(part.begin(), part.end(), [&](const Taken& t) { return at(t)[axis] < limit; });
    split({part.begin(), middle});
    split({middle, part.end()});
  }

  void append(std::span<const Taken> part) {
    PointGroup group;
    group.first = static_cast<std::uint32_t>(out_.pixels.size());
    group.count = static_cast<std::uint32_t>(part.size());
    group.first_receiver = static_cast<std::uint32_t>(out_.receivers.size());
    group.low = dvec3(INFINITY), group.high = dvec3(-INFINITY);
    for (const Taken& t : part) {
      out_.pixels.push_back(t.pixel);
      out_.positions.push_back(at(t));
      out_.triangles.push_back(t.receiver.triangle);
      group.low = glm::min(group.low, at(t)), group.high = glm::max(group.high, at(t));
      if (out_.receivers.size() == group.first_receiver ||
          out_.receivers.back().triangle != t.receiver.triangle)
        out_.receivers.push_back(t.receiver);
    }
    const auto begin = out_.receivers.begin() + group.first_receiver;
    std::sort(begin, out_.receivers.end(), [](auto& a, auto& b) { return a.triangle < b.triangle; });
    out_.receivers.erase(
        std::unique(begin, out_.receivers.end(), [](auto& a, auto& b) { return a.triangle == b.triangle; }),
        out_.receivers.end());
    group.receiver_count = static_cast<std::uint32_t>(out_.receivers.size()) - group.first_receiver;
    out_.groups.push_back(group);
  }

  static constexpr double gap_share = 0.3;  // evenly spaced rows of pixels leave gaps of 1/7

  const VisiblePoints& points_;
  const ViewRays& view_;
  const TriangleView& triangles_;
  const AreaLight& light_;
  PointGroups& out_;
  Reach reach_;
  std::vector<Taken> taken_;
};

template <class T>
void append_to(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void append(PointGroups& to, const PointGroups& from) {
  const auto first = static_cast<std::uint32_t>(to.pixels.size());
  const auto first_receiver = static_cast<std::uint32_t>(to.receivers.size());
  for (PointGroup group : from.groups) {
    group.first += first;
    group.first_receiver += first_receiver;
    to.groups.push_back(group);
  }
  append_to(to.pixels, from.pixels);
  append_to(to.positions, from.positions);
  append_to(to.triangles, from.triangles);
  append_to(to.receivers, from.receivers);
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

}  // namespace

int seen_side(const TriangleView& triangles, std::uint32_t id, const ViewRays& view) {
  const Corners c = corners_of(triangles, id);
  return view.orthographic ? -direction_side(c.v[0], c.v[1], c.v[2], view.d0)
                           : point_side(c.v[0], c.v[1], c.v[2], view.eye);
}

void group_points(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                  const AreaLight& light, SoftGrouping grouping, PointGroups& out) {
  const FloatEnvironment ieee;
  out.groups.clear();
  out.pixels.clear();
  out.positions.clear();
  out.triangles.clear();
  out.receivers.clear();
  if (grouping == SoftGrouping::triangle) {
    Grouper grouper(points, view, triangles, light, out);
    std::uint32_t current = no_triangle;
    for (const std::uint32_t pixel : pixels_by_triangle(points, triangles.triangles.size())) {
      if (points.triangles[pixel] != current) grouper.close_whole();
      current = points.triangles[pixel];
      grouper.take(pixel);
    }
    grouper.close_whole();
    return;
  }
  const auto width = static_cast<std::uint32_t>(points.width),
             height = static_cast<std::uint32_t>(points.height);
  const std::uint32_t rows = (height + tile - 1) / tile;
  std::vector<PointGroups> bands(rows);
  parallel_tasks(static_cast<int>(rows), [&](int row) {
    Grouper grouper(points, view, triangles, light, bands[row]);
    const std::uint32_t top = static_cast<std::uint32_t>(row) * tile;
    for (std::uint32_t left = 0; left < width; left += tile) {
      for (std::uint32_t y = top; y < std::min(top + tile, height); ++y)
        for (std::uint32_t x = left; x < std::min(left + tile, width); ++x) grouper.take(y * width + x);
      grouper.close();
    }
  });
  for (const PointGroups& band : bands) append(out, band);
}

}  // namespace tenebra
