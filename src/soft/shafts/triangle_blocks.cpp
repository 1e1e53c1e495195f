#include "soft/shafts/triangle_blocks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra::soft {

namespace {

// Fills blocks triangle by triangle, and the list's first references in place: a block has no fewer triangles
// than those that it takes them from, so that no reference is overwritten before it was read.
class BlockWriter {
public:
  explicit BlockWriter(BlockList& list) : list_(list) {}

  /// The lane to write; finish() it.
  TriangleBlock& next(int& lane) {
    if (used_ == block_size) close();
    if (used_ == 0) list_.own.emplace_back();
    lane = used_++;
    return list_.own.back();
  }
  /// Behind the last triangle.
  void finish() {
    close();
    list_.refs.resize(closed_);
  }

  static void copy_lane(const TriangleBlock& from, int i, TriangleBlock& to, int k) {
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis) to.v[corner][axis][k] = from.v[corner][axis][i];
    to.largest[k] = from.largest[i];
    to.size[k] = from.size[i];
    to.ids[k] = from.ids[i];
  }

private:
  void close() {
    if (used_ == 0) return;
    TriangleBlock& b = list_.own.back();
    for (int lane = used_; lane < block_size; ++lane) copy_lane(b, 0, b, lane);
    list_.refs[closed_++] = {static_cast<std::uint32_t>(list_.own.size() - 1), (1u << used_) - 1};
    used_ = 0;
  }

  BlockList& list_;
  std::size_t closed_ = 0;  // blocks
  int used_ = 0;            // lanes of the last
};

// Sizes of the triangles whose corners are there.
void find_sizes(TriangleBlock& block) {
  for (int lane = 0; lane < block_size; ++lane) block.largest[lane] = block.size[lane] = 0;
  for (int corner = 0; corner < 3; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const float* here = block.v[corner][axis];
      const float* next = block.v[(corner + 1) % 3][axis];
      for (int lane = 0; lane < block_size; ++lane) {
        block.largest[lane] = std::max(block.largest[lane], std::abs(here[lane]));
        block.size[lane] = std::max(block.size[lane], std::abs(next[lane] - here[lane]));
      }
    }
  }
  // Rounded to nearest; one more unit in the last place makes it a bound.
  for (float& size : block.size) size *= 1 + std::numeric_limits<float>::epsilon();
}

// Triangles 8b to 8b + 7; returns the lanes of those that may block.
std::uint8_t gather_block(const TriangleView& triangles, std::size_t b, TriangleBlock& block) {
  std::uint32_t casting = 0;
  for (int lane = 0; lane < block_size; ++lane) {
    const std::size_t id = b * block_size + static_cast<std::size_t>(lane);
    const bool exists = id < triangles.triangles.size();
    const points::Corners c = exists ? points::corners_of(triangles, id) : points::Corners{};
    block.ids[lane] = exists ? static_cast<std::uint32_t>(id) : no_triangle;
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis) block.v[corner][axis][lane] = c.v[corner][axis];
    const bool flat = c.v[0] == c.v[1] || c.v[1] == c.v[2] || c.v[2] == c.v[0];  // blocks nothing
    const bool casts = exists && (triangles.casts_shadow.empty() || triangles.casts_shadow[id] != 0);
    casting |= static_cast<std::uint32_t>(casts && !flat) << lane;
  }
  find_sizes(block);
  return static_cast<std::uint8_t>(casting);
}

}  // namespace

std::size_t BlockList::triangle_count() const {
  std::size_t count = 0;
  for (const BlockRef& ref : refs) count += static_cast<std::size_t>(std::popcount(ref.lanes));
  return count;
}

void BlockList::append_ids(std::vector<std::uint32_t>& ids) const {
  for (const BlockRef& ref : refs)
    for (std::uint32_t lanes = ref.lanes; lanes != 0; lanes &= lanes - 1)
      ids.push_back(block(ref).ids[std::countr_zero(lanes)]);
}

void BlockList::compact() {
  const std::size_t count = triangle_count();
  if (2 * count > block_size * refs.size()) return;
  own.clear();
  own.reserve(count / block_size + 1);
  BlockWriter writer(*this);
  for (std::size_t k = 0; k < refs.size(); ++k) {
    const BlockRef ref = refs[k];
    for (std::uint32_t lanes = ref.lanes; lanes != 0; lanes &= lanes - 1) {
      const int i = std::countr_zero(lanes);
      int lane = 0;
      TriangleBlock& b = writer.next(lane);
      BlockWriter::copy_lane(blocks[ref.block], i, b, lane);
    }
  }
  writer.finish();
  blocks = own.data();
}

void gather_casters(const TriangleView& triangles, BlockList& out) {
  const std::size_t count = triangles.triangles.size();
  out.own.resize((count + block_size - 1) / block_size);
  out.blocks = out.own.data();
  out.refs.resize(out.own.size());
  parallel::parallel_ranges(out.own.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b)
      out.refs[b] = {static_cast<std::uint32_t>(b), gather_block(triangles, b, out.own[b])};
  });
  std::erase_if(out.refs, [](const BlockRef& ref) { return ref.lanes == 0; });
}

}  // namespace tenebra::soft
