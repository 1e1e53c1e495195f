#include "soft/triangle_blocks.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "points/triangle_corners.h"

namespace tenebra {

namespace {

// Fills blocks triangle by triangle.
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
  void close() {
    if (used_ == 0) return;
    TriangleBlock& b = list_.own.back();
    for (int lane = used_; lane < block_size; ++lane) copy_lane(b, 0, b, lane);
    list_.refs.push_back({static_cast<std::uint32_t>(list_.own.size() - 1), (1u << used_) - 1});
    used_ = 0;
  }

  static void copy_lane(const TriangleBlock& from, int i, TriangleBlock& to, int k) {
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis) to.v[corner][axis][k] = from.v[corner][axis][i];
    to.largest[k] = from.largest[i];
    to.size[k] = from.size[i];
    to.ids[k] = from.ids[i];
  }

private:
  BlockList& list_;
  int used_ = 0;
};

float edge_size(const Corners& c) {
  double size = 0;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 edge = glm::abs(glm::dvec3(c.v[(k + 1) % 3]) - glm::dvec3(c.v[k]));
    size = std::max({size, edge.x, edge.y, edge.z});
  }
  return std::nextafter(static_cast<float>(size), INFINITY);
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
  std::vector<BlockRef> from;
  from.swap(refs);
  own.clear();
  own.reserve(count / block_size + 1);
  BlockWriter writer(*this);
  for (const BlockRef& ref : from) {
    for (std::uint32_t lanes = ref.lanes; lanes != 0; lanes &= lanes - 1) {
      const int i = std::countr_zero(lanes);
      int lane = 0;
      TriangleBlock& b = writer.next(lane);
      BlockWriter::copy_lane(blocks[ref.block], i, b, lane);
    }
  }
  writer.close();
  blocks = own.data();
}

void gather_casters(const TriangleView& triangles, BlockList& out) {
  out.own.clear();
  out.refs.clear();
  BlockWriter writer(out);
  for (std::uint32_t id = 0; id < triangles.triangles.size(); ++id) {
    if (!triangles.casts_shadow.empty() && triangles.casts_shadow[id] == 0) continue;
    const Corners c = corners_of(triangles, id);
    if (c.v[0] == c.v[1] || c.v[1] == c.v[2] || c.v[2] == c.v[0]) continue;  // blocks nothing
    int lane = 0;
    TriangleBlock& b = writer.next(lane);
    b.largest[lane] = 0;
    b.ids[lane] = id;
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        b.v[corner][axis][lane] = c.v[corner][axis];
        b.largest[lane] = std::max(b.largest[lane], std::abs(c.v[corner][axis]));
      }
    }
    b.size[lane] = edge_size(c);
  }
  writer.close();
  out.blocks = out.own.data();
}

}  // namespace tenebra
