// A tree over the see-through triangles of a frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/visible_points.h>
#include "trees/shaft_search.h"

namespace tenebra::tint {

class PaneTree {
public:
  /// Triangles `ids` as they lie now. Their order in the tree is kept while the ids stay what they are.
  void update(std::span<const std::uint32_t> ids, const TriangleView& triangles);
  /// The code that find() and meets() run.
  void use(SimdLevel level) { search_ = trees::shaft_search(level); }

  const math::Box<double>& box() const { return box_; }  ///< of all triangles

  /// Appends the triangles that may meet the shaft: none that does is left out.
  void find(const trees::BoxShaft& shaft, std::vector<trees::BlockTriangles>& out) const {
    search_.find(tree_, floats_of(shaft), out);
  }
  /// Whether there are any such.
  bool meets(const trees::BoxShaft& shaft) const { return search_.any(tree_, floats_of(shaft)); }
  /// Fills `out` with the places in `ids` of the triangles found, in order.
  void numbers_of(std::span<const trees::BlockTriangles> found, std::vector<std::uint32_t>& out) const;
  /// Place in `ids` of triangle `lane` of a block.
  std::uint32_t number(std::uint32_t block, int lane) const { return tree_.blocks[block].triangle[lane]; }

private:
  trees::FloatShaft floats_of(const trees::BoxShaft& shaft) const {
    return {shaft, box_.largest_coordinate()};
  }

  std::vector<std::uint32_t> ids_;
  trees::TriangleBvh tree_;  ///< of the places in ids
  math::Box<double> box_;
  trees::ShaftSearch search_ = trees::shaft_search(SimdLevel::automatic);
};

}  // namespace tenebra::tint
