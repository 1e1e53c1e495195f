// Triangles in blocks of eight, coordinate by coordinate, and lists of such blocks with a mask of the
// triangles that are still in question.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/visible_points.h>

namespace tenebra::soft {

inline constexpr int block_size = 8;

/// Idle lanes hold triangles that are not asked about.
struct TriangleBlock {
  float v[3][3][block_size];  ///< corner, axis, triangle; world space
  float largest[block_size];  ///< largest |coordinate| of each triangle: tau is sqrt(3) 2^-24 times this
  float size[block_size];     ///< largest |coordinate| of its edges, rounded up
  std::uint32_t ids[block_size];
};

/// Triangles `lanes` (bit i: triangle i) of block `block`.
struct BlockRef {
  std::uint32_t block = 0;
  std::uint32_t lanes = 0;
};

/// References into blocks that it owns, or that a list above it owns.
struct BlockList {
  std::vector<TriangleBlock> own;
  std::vector<BlockRef> refs;
  const TriangleBlock* blocks = nullptr;

  const TriangleBlock& block(const BlockRef& ref) const { return blocks[ref.block]; }
  std::size_t triangle_count() const;
  void append_ids(std::vector<std::uint32_t>& ids) const;
  /// Copies the triangles in question into blocks of its own if at least half of the lanes are idle.
  void compact();
};

/// All casting triangles, eight ids to a block; those with two equal corners, which block nothing, are left
/// out.
void gather_casters(const TriangleView& triangles, BlockList& out);

}  // namespace tenebra::soft
