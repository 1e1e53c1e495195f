// Which triangles of a tree may meet a shaft, eight boxes at a time.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/simd_level.h>
#include "trees/box_shaft.h"
#include "trees/triangle_bvh.h"

namespace tenebra::trees {

/// Triangles of a block of a tree, one bit for each.
struct BlockTriangles {
  std::uint32_t block = 0, lanes = 0;
};

/// Code for one instruction set. A triangle is found if its box may meet the shaft: conservative, and the
/// same whatever lies with it in the tree. Shafts: for the largest coordinate of the tree's triangles, or
/// more.
struct ShaftSearch {
  /// Appends all of them, by blocks.
  void (*find)(const TriangleBvh& bvh, const FloatShaft& shaft, std::vector<BlockTriangles>& out) = nullptr;
  /// Whether there are any.
  bool (*any)(const TriangleBvh& bvh, const FloatShaft& shaft) = nullptr;
};
ShaftSearch shaft_search(SimdLevel level);

}  // namespace tenebra::trees
