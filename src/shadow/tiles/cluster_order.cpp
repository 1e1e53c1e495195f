#include "shadow/tiles/cluster_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::vec3;

// Longest edge in units of the scene's longest side: above the first, above the second, below.
constexpr float class_limits[] = {1.0f / 16, 1.0f / 128};
constexpr std::size_t class_count = 3, cluster = 16, node = 256;

std::uint32_t spread_by_two(std::uint32_t v) {
  std::uint32_t r = 0;
  for (int bit = 0; bit < 10; ++bit) r |= ((v >> bit) & 1u) << (3 * bit);
  return r;
}

struct Frame {
  vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};

  float longest() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
  /// Morton code of 30 bits; points that are not finite get any.
  std::uint32_t morton(const vec3& p) const {
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = high[axis] - low[axis];
      const float place = extent > 0 ? (p[axis] - low[axis]) / extent : 0.0f;
      const float cell = place > 0 ? std::min(place, 1.0f) * 1023.0f : 0.0f;
      code |= spread_by_two(static_cast<std::uint32_t>(cell)) << axis;
    }
    return code;
  }
};

vec3 centre_of(const Corners& c) {
  return c.v[0] / 3.0f + c.v[1] / 3.0f + c.v[2] / 3.0f;
}

Frame frame_of(const TriangleView& t) {
  Frame frame;
  for (const vec3& p : t.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    frame.low = glm::min(frame.low, p);
    frame.high = glm::max(frame.high, p);
  }
  return frame;
}

/// Rank of each part along the curve, by its first triangle.
std::vector<std::uint32_t> part_ranks(const TriangleView& t, const Frame& frame) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> keys;
  for (std::uint32_t i = 0; i < t.parts.size(); ++i) {
    const bool there = t.parts[i] < t.triangles.size();
    keys.emplace_back(there ? frame.morton(centre_of(corners_of(t, t.parts[i]))) : 0u, i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> ranks(std::max<std::size_t>(1, keys.size()), 0);
  for (std::uint32_t r = 0; r < keys.size(); ++r) ranks[keys[r].second] = r;
  return ranks;
}

float longest_edge(const Corners& c) {
  return std::max({glm::length(c.v[1] - c.v[0]), glm::length(c.v[2] - c.v[1]), glm::length(c.v[0] - c.v[2])});
}

struct Key {
  std::uint64_t place;  // rank of the part, Morton code
  std::uint32_t id;
  bool operator<(const Key& other) const {
    return place != other.place ? place < other.place : id < other.id;
  }
};

}  // namespace

void cluster_order(const TriangleView& t, std::vector<std::uint32_t>& order) {
  const Frame frame = frame_of(t);
  const std::vector<std::uint32_t> ranks = part_ranks(t, frame);
  std::vector<Key> classes[class_count];
  std::size_t part = 0;
  for (std::uint32_t id = 0; id < t.triangles.size(); ++id) {
    while (part + 1 < t.parts.size() && t.parts[part + 1] <= id) ++part;
    if (!t.casts_shadow.empty() && t.casts_shadow[id] == 0) continue;
    const Corners c = corners_of(t, id);
    const float size = longest_edge(c) / frame.longest();
    const std::size_t k = size > class_limits[0] ? 0 : size > class_limits[1] ? 1 : 2;
    classes[k].push_back({static_cast<std::uint64_t>(ranks[part]) << 30 | frame.morton(centre_of(c)), id});
  }
  parallel_tasks(class_count, [&](int k) { std::sort(classes[k].begin(), classes[k].end()); });
  order.clear();
  for (const auto& keys : classes) {
    if (!keys.empty()) order.resize((order.size() + node - 1) / node * node, no_triangle);
    for (const Key& key : keys) order.push_back(key.id);
  }
  order.resize((order.size() + cluster - 1) / cluster * cluster, no_triangle);
}

}  // namespace tenebra
