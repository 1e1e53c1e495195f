// The lazily grown BSP of line classes (Mora et al. 2012, Algorithm 1): inner nodes hold the hyperplanes of
// occluders' edges, leaves are visible, invisible or undefined classes of the lines between a group of points
// and the light. This part grows the tree; line_class_query-inl.h asks it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/soft_config.h>
#include <tenebra/visible_points.h>
#include "soft/bsp/group_occluders.h"

namespace tenebra::soft {

/// A child of a node: a node's index, or a leaf.
using BspChild = std::int32_t;
inline constexpr BspChild visible_leaf = -1;    ///< no occluder meets these lines
inline constexpr BspChild invisible_leaf = -2;  ///< one occluder meets all of them
/// Undefined leaf: the class is not known yet, occluders wait in pending list -3 - child.
inline bool is_undefined(BspChild child) {
  return child <= -3;
}

struct BspNode {
  std::uint32_t line = 0;                            ///< index into GroupOccluders::lines
  BspChild child[2] = {visible_leaf, visible_leaf};  ///< on the line's negative and positive side
};

class LineClassBsp {
public:
  /// A tree of one undefined leaf that all definite occluders wait in. They must outlive it. It takes at most
  /// `largest_bytes`: false, and no tree, if its occluders alone take more.
  bool reset(const GroupOccluders& occluders, const TriangleView& triangles, const GroupFrame& group,
             OccluderChoice choice, std::size_t largest_bytes);

  BspChild root() const { return root_; }
  const BspNode* nodes() const { return nodes_.data(); }

  /// Memory in use, not what is kept for later trees: a function of the tree alone.
  std::size_t bytes() const;

  /// Replaces the undefined leaf at `child` (the root: parent < 0) by the classes of one of its occluders and
  /// inserts the others below (Algorithm 1, lines 31 to 35). Returns the new child. If the tree might outgrow
  /// its bound, nothing changes and the undefined leaf is returned.
  BspChild grow(std::int32_t parent, int side);

  std::size_t node_count() const { return nodes_.size(); }

private:
  enum class Orientation { negative, mixed, positive };
  struct Range {
    std::uint32_t first = 0, count = 0;
  };

  Orientation orientation(std::uint32_t line, std::uint32_t occluder) const;
  void insert_below(std::uint32_t occluder, const Occluder& merged);
  std::uint32_t pick(Range waiting);
  BspChild add_leaf(std::span<const std::uint32_t> occluders);
  bool may_take(std::size_t bytes) const { return bytes <= largest_bytes_; }

  std::vector<BspNode> nodes_;
  std::vector<std::uint32_t> waiting_;  ///< occluders of all pending lists, one after another
  std::vector<Range> lists_;            ///< pending lists in waiting_
  std::vector<std::uint32_t>
      outside_[4];  ///< scratch of grow: the occluders that reach outside of each line in the leaf
  std::vector<glm::dvec3> corners_;  ///< three for each occluder, relative to the group's centre
  std::span<const Occluder> occluders_;
  std::span<const EdgePlane> planes_;
  glm::dvec3 half_{0.0};
  BspChild root_ = visible_leaf;
  OccluderChoice choice_ = OccluderChoice::largest;
  std::size_t largest_bytes_ = 0;
  std::uint32_t random_ = 1;
};

}  // namespace tenebra::soft
