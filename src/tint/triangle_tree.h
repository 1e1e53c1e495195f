// A tree of boxes, eight children to a node, over the see-through triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/visible_points.h>
#include "tint/shaft.h"
#include "tint/tint_kernels.h"

namespace tenebra::tint {

class TriangleTree {
public:
  /// Triangles `ids` as they lie now. Their order in the tree is kept while the ids stay what they are.
  void update(std::span<const std::uint32_t> ids, const TriangleView& triangles);
  /// The code that find() and meets() run.
  void use(const TintKernels& kernels) { boxes_met_ = kernels.boxes_met; }

  bool empty() const { return order_.empty(); }
  const Box& box() const { return box_; }

  /// A leaf of up to eight triangles, with the bits of those that may meet a shaft.
  struct Found {
    std::uint32_t leaf = 0, met = 0;
  };
  /// Appends the leaves with triangles that may meet the shaft: none that does is left out.
  void find(const Shaft& shaft, std::vector<Found>& out) const;
  /// Whether there are any such.
  bool meets(const Shaft& shaft) const;
  /// Fills `out` with the places in `ids` of the triangles found, in order.
  void numbers_of(std::span<const Found> found, std::vector<std::uint32_t>& out) const;
  /// Place in `ids` of triangle `lane` of a leaf.
  std::uint32_t number(std::uint32_t leaf, int lane) const {
    return order_[leaf * box_lanes + static_cast<std::uint32_t>(lane)];
  }

private:
  void order(const TriangleView& triangles);
  void find_below(std::size_t level, std::uint32_t node, const FloatShaft& shaft,
                  std::vector<Found>& out) const;
  bool meets_below(std::size_t level, std::uint32_t node, const FloatShaft& shaft) const;

  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> order_;             ///< places in ids
  std::vector<std::vector<EightBoxes>> levels_;  ///< of triangles, then of the nodes of the level before
  Box box_;
  double reach_ = 0;  ///< largest |coordinate|
  decltype(TintKernels::boxes_met) boxes_met_ = tint_kernels(SimdLevel::automatic).boxes_met;
};

}  // namespace tenebra::tint
