// Rules for every way of making a tree of triangles: which triangles are in it, how large boxes are, how
// nodes and blocks are filled.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "trees/triangle_bvh.h"

namespace tenebra::trees {

/// Half of a box's surface, in double: squares of 1e18 stay in range.
inline double half_area(const math::Box<float>& box) {
  if (box.empty()) return 0;
  const glm::dvec3 size = glm::dvec3(box.high) - glm::dvec3(box.low);
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Whether a tree holds the triangle; then, in `box`, its box.
inline bool bvh_holds(std::span<const glm::vec3> positions, const glm::uvec3& t, BvhHolds holds,
                      math::Box<float>& box) {
  // With `all`, nothing is decided by products of coordinates.
  const float largest_coordinate = holds == BvhHolds::all ? std::numeric_limits<float>::max() : 1e18f;
  if (std::max({t.x, t.y, t.z}) >= positions.size()) return false;
  const glm::vec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
  for (const glm::vec3& p : {a, b, c})
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(p[axis]) <= largest_coordinate)) return false;
  if (holds == BvhHolds::with_area &&
      glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)) == glm::dvec3(0))
    return false;
  box = {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
  return true;
}

/// By how much a node's boxes are wider than what they hold: a hit that rounding puts beside its triangle
/// still lies in the triangle's box. At least four units in the last place of the tree's largest coordinate.
inline float bvh_margin(float largest_coordinate) {
  return largest_coordinate * 0x1p-21f;
}

inline void set_child(BvhNode& node, std::size_t lane, std::uint32_t child, const math::Box<float>& box,
                      float margin) {
  node.child[lane] = child;
  for (int axis = 0; axis < 3; ++axis) {
    node.plane[axis][lane] = box.low[axis] - margin;
    node.plane[axis + 3][lane] = box.high[axis] + margin;
  }
}

/// An empty box stays empty, however wide the margin.
inline void set_no_child(BvhNode& node, std::size_t lane) {
  set_child(node, lane, bvh_no_child, {}, 0);
}

inline BvhTriangles empty_block() {
  BvhTriangles block{};
  std::fill(std::begin(block.triangle), std::end(block.triangle), no_caster);
  return block;
}

inline void set_triangle(BvhTriangles& block, std::size_t lane, std::uint32_t triangle,
                         std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
  block.triangle[lane] = triangle;
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis)
      block.corner[corner][axis][lane] = positions[triangles[triangle][corner]][axis];
}

}  // namespace tenebra::trees
