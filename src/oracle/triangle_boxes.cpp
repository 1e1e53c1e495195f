#include "oracle/triangle_boxes.h"

#include <algorithm>
#include <limits>

namespace tenebra::oracle {
namespace {

glm::dvec3 doubled_centre(const OracleTriangles& triangles, std::uint32_t id) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 p = triangles.corner(id, k);
    low = glm::min(low, p), high = glm::max(high, p);
  }
  return low + high;
}

}  // namespace

TriangleBoxes::TriangleBoxes(const OracleTriangles& triangles, std::vector<std::uint32_t> ids)
    : ids_(std::move(ids)) {
  if (!ids_.empty()) split(triangles, 0, static_cast<std::uint32_t>(ids_.size()));
}

void TriangleBoxes::split(const OracleTriangles& triangles, std::uint32_t first, std::uint32_t count) {
  const std::size_t index = nodes_.size();
  Node node;
  node.low = glm::dvec3(std::numeric_limits<double>::infinity());
  node.high = -node.low;
  glm::dvec3 centre_low = node.low, centre_high = node.high;
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 p = triangles.corner(ids_[i], k);
      node.low = glm::min(node.low, p), node.high = glm::max(node.high, p);
    }
    const glm::dvec3 centre = doubled_centre(triangles, ids_[i]);
    centre_low = glm::min(centre_low, centre), centre_high = glm::max(centre_high, centre);
  }
  node.first = first, node.count = count;
  nodes_.push_back(node);
  if (count <= 2) return;
  const glm::dvec3 extent = centre_high - centre_low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  const auto begin = ids_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return doubled_centre(triangles, a)[axis] < doubled_centre(triangles, b)[axis];
  });
  split(triangles, first, half);
  nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
  split(triangles, first + half, count - half);
}

// Boxes are exact. With lo - P, d and their quotient each within 2^-53 of the real value, a quotient
// is within 4 * 2^-53 of the real parameter, relatively; `widen` moves it outwards by 8 * 2^-53 of its size,
// and by 1e-300 where it may have underflown. An infinite quotient stands for a parameter far beyond t_max,
// and is kept. lo - P is 0 only if exactly so, d is 0 only if exactly so: then the axis asks whether P lies
// in the slab.
bool TriangleBoxes::may_meet(const Segment& segment, const Node& node) {
  constexpr double widen = 0x1p-50;
  double enter = 0, leave = segment.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double p = segment.origin[axis], d = segment.direction[axis];
    if (d == 0) {
      if (p < node.low[axis] || p > node.high[axis]) return false;
      continue;
    }
    double t0 = (node.low[axis] - p) / d, t1 = (node.high[axis] - p) / d;
    if (t0 > t1) std::swap(t0, t1);
    enter = std::max(enter, t0 - widen * std::abs(t0) - 1e-300);
    leave = std::min(leave, t1 + widen * std::abs(t1) + 1e-300);
  }
  return !(enter > leave);
}

}  // namespace tenebra::oracle
