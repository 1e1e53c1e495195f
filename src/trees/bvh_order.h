// The part of a tree that takes long to find: which triangles lie together, and how blocks and nodes are
// linked. Everything else follows from the triangles, so a tree made from any order is right.
#pragma once

#include <optional>
#include <vector>

#include "trees/triangle_bvh.h"

namespace tenebra::trees {

struct BvhOrder {
  static constexpr std::uint8_t node = 0xff;
  std::vector<std::uint8_t>
      children;  ///< eight per node: 0 none, 1..8 a block of that many triangles, `node`
  std::vector<std::uint32_t> triangles;  ///< of the blocks, one after the other
  friend bool operator==(const BvhOrder&, const BvhOrder&) = default;
};
BvhOrder order_of(const TriangleBvh& bvh);

/// The tree of these triangles whose order this is, bit for bit; none if it is not the order of a tree of all
/// of them.
std::optional<TriangleBvh> order_triangles(std::span<const glm::vec3> positions,
                                           std::span<const glm::uvec3> triangles, const BvhOrder& order);

}  // namespace tenebra::trees
