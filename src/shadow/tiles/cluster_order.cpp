#include "shadow/tiles/cluster_order.h"

#include <algorithm>
#include <cmath>

#include "base/until_stopped.h"
#include "math/box.h"
#include "parallel/parallel.h"
#include "points/triangle_corners.h"
#include "shadow/tiles/triangle_clusters.h"

namespace tenebra::shadow {

namespace {

using glm::vec3;

// Limits of the classes of size, for a triangle's longest edge over the scene's longest side.
constexpr float class_limits[] = {1.0f / 16, 1.0f / 128};
constexpr std::size_t class_count = 3, node_size = 256;

bool is_finite(const vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// The longest side of the box around all vertices.
float extent_of(const TriangleView& t) {
  math::Box<float> box;
  for (const vec3& p : t.positions)
    if (is_finite(p)) box.add(p);
  const vec3 size = box.high - box.low;
  return std::max({size.x, size.y, size.z});
}

struct Item {
  std::uint32_t id;
  vec3 centre;  ///< finite
};

Item item_of(std::uint32_t id, const points::Corners& c) {
  const vec3 centre = c.v[0] / 3.0f + c.v[1] / 3.0f + c.v[2] / 3.0f;
  return {id, is_finite(centre) ? centre : vec3(0.0f)};
}

/// Orders items first ... last - 1 so that near ones come together: cuts them in two across the longest side
/// of their box, then each half again. Cuts lie at multiples of `unit`, or of `larger` while at least two of
/// these remain. Ends early if a stop is requested.
void cut_in_halves(std::vector<Item>& items, std::size_t first, std::size_t last, std::size_t unit,
                   std::size_t larger, const StopFlag* stop) {
  if (stop_requested(stop)) return;
  const std::size_t step = last - first >= 2 * larger ? larger : unit;
  const std::size_t middle = (first + (last - first) / 2 + step / 2) / step * step;
  if (middle <= first || middle >= last) return;
  math::Box<float> box;
  for (std::size_t i = first; i < last; ++i) box.add(items[i].centre);
  const int axis = box.longest_side();
  const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [axis](const Item& a, const Item& b) {
    return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.id < b.id;
  });
  cut_in_halves(items, first, middle, unit, larger, stop);
  cut_in_halves(items, middle, last, unit, larger, stop);
}

/// Triangles first ... last - 1.
struct Part {
  std::uint32_t first, last;
};

/// All parts, near ones together by their first triangles.
std::vector<Part> parts_in_order(const TriangleView& t, const StopFlag* stop) {
  const auto count = static_cast<std::uint32_t>(t.triangles.size());
  if (t.parts.empty()) return {{0, count}};
  std::vector<Item> items;
  for (std::uint32_t i = 0; i < t.parts.size(); ++i)
    items.push_back(t.parts[i] < count ? item_of(i, points::corners_of(t, t.parts[i])) : Item{i, vec3(0.0f)});
  cut_in_halves(items, 0, items.size(), 1, 1, stop);
  std::vector<Part> parts;
  for (const Item& item : items) {
    const bool is_last = item.id + 1 == t.parts.size();
    parts.push_back({item.id == 0 ? 0 : t.parts[item.id], is_last ? count : t.parts[item.id + 1]});
  }
  return parts;
}

float longest_edge(const points::Corners& c) {
  return std::max({glm::length(c.v[1] - c.v[0]), glm::length(c.v[2] - c.v[1]), glm::length(c.v[0] - c.v[2])});
}

/// Casters of one class of size, and where each part of them begins.
struct SizeClass {
  std::vector<Item> items;
  std::vector<std::size_t> begins;
};

void sort_class(SizeClass& c, const StopFlag* stop) {
  c.begins.push_back(c.items.size());
  for (std::size_t i = 0; i + 1 < c.begins.size(); ++i)
    cut_in_halves(c.items, c.begins[i], c.begins[i + 1], cluster_size, node_size, stop);
}

}  // namespace

void cluster_order(const TriangleView& t, std::vector<std::uint32_t>& order, const StopFlag* stop) {
  const float extent = extent_of(t);
  SizeClass classes[class_count];
  for (SizeClass& c : classes) c.items.reserve(t.triangles.size());  // a list that grows copies what it has
  for (const Part& part : parts_in_order(t, stop)) {
    for (SizeClass& c : classes) c.begins.push_back(c.items.size());
    base::each_until_stopped(part.first, part.last, stop, [&](std::size_t i) {
      if (!t.casts_shadow.empty() && t.casts_shadow[i] == 0) return;
      const auto id = static_cast<std::uint32_t>(i);
      const points::Corners c = points::corners_of(t, id);
      const float size = longest_edge(c) / extent;
      classes[size > class_limits[0] ? 0 : size > class_limits[1] ? 1 : 2].items.push_back(item_of(id, c));
    });
    if (stop_requested(stop)) return;
  }
  parallel::parallel_tasks(class_count, [&](int k) { sort_class(classes[k], stop); });
  if (stop_requested(stop)) return;
  order.clear();
  for (const SizeClass& c : classes) {
    if (!c.items.empty()) order.resize((order.size() + node_size - 1) / node_size * node_size, no_triangle);
    for (const Item& item : c.items) order.push_back(item.id);
  }
  order.resize((order.size() + cluster_size - 1) / cluster_size * cluster_size, no_triangle);
}

}  // namespace tenebra::shadow
