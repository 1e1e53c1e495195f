#include "shadow/tiles/ray_forest.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"
#include "shadow/ray_kernels.h"
#include "shadow/tiles/square_tiles.h"

namespace tenebra {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

void widen(FaceBox& to, const FaceBox& by) {
  to.u0 = std::min(to.u0, by.u0), to.u1 = std::max(to.u1, by.u1);
  to.v0 = std::min(to.v0, by.v0), to.v1 = std::max(to.v1, by.v1);
  to.w = std::min(to.w, by.w), to.w1 = std::max(to.w1, by.w1);
}

/// Key and place of everything that is sorted: in the order of the rows, so that it does not depend on
/// threads.
void add_keys(const std::vector<std::uint32_t>& keys, RayKeys& to) {
  for (const std::uint32_t key : keys)
    to.keys.push_back(static_cast<std::uint64_t>(key) << 32 | to.keys.size());
}

std::uint32_t place_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

/// Gathers what the rows gave: tiles behind those of the squares, nodes, loose tiles, in the order of rows.
void gather_rows(std::size_t slots, ForestScratch& s, RayForest& out) {
  s.nodes.clear(), s.node_faces.clear(), s.loose.clear();
  s.node_keys.keys.clear(), s.loose_keys.keys.clear();
  out.at_light.clear();
  out.rays = 0;
  out.tau = 0;
  out.in_range = true;
  std::size_t split = slots;
  for (const ForestScratch::Row& row : s.rows) split += row.split.size();
  out.tiles.resize(split);
  split = slots;
  for (const ForestScratch::Row& row : s.rows) {
    std::copy(row.split.begin(), row.split.end(), out.tiles.begin() + static_cast<std::ptrdiff_t>(split));
    for (ForestScratch::Loose loose : row.loose) {
      if (loose.tile >= slots) loose.tile += static_cast<std::uint32_t>(split - slots);
      s.loose.push_back(loose);
    }
    split += row.split.size();
    s.nodes.insert(s.nodes.end(), row.nodes.begin(), row.nodes.end());
    s.node_faces.insert(s.node_faces.end(), row.node_faces.begin(), row.node_faces.end());
    add_keys(row.node_keys, s.node_keys);
    add_keys(row.loose_keys, s.loose_keys);
    out.at_light.insert(out.at_light.end(), row.at_light.begin(), row.at_light.end());
    out.rays += row.rays;
    out.tau = std::max(out.tau, row.tau);
    out.in_range &= row.in_range;
  }
}

/// Loose tiles in the order of the curve become nodes of sixteen on one face, with the key of their first.
void group_loose(ForestScratch& s) {
  radix_sort(s.loose_keys.keys, s.loose_keys);
  const auto& keys = s.loose_keys.keys;
  for (std::size_t i = 0; i < keys.size();) {
    const std::uint8_t face = s.loose[place_of(keys[i])].face;
    s.node_keys.keys.push_back(keys[i] >> 32 << 32 | s.nodes.size());
    s.node_faces.push_back(face);
    RayNode& node = s.nodes.emplace_back();
    for (int k = 0; k < 16 && i < keys.size() && s.loose[place_of(keys[i])].face == face; ++k, ++i) {
      const ForestScratch::Loose& loose = s.loose[place_of(keys[i])];
      node.child[k] = loose.tile;
      node.own[k] = loose.own;
      node.set_box(k, loose.box);
      node.live |= 1u << k;
    }
    node.filled = node.live;
  }
}

/// Appends `child` of level `level` to the last node of the level above, or to a new one.
void append(RayForest& f, int level, bool fresh) {
  auto& above = f.levels[static_cast<std::size_t>(level) + 1];
  auto& own = f.levels[static_cast<std::size_t>(level)];
  if (fresh) above.emplace_back();
  RayNode& parent = above.back();
  const int slot = std::popcount(parent.live);
  parent.child[slot] = static_cast<std::uint32_t>(own.size() - 1);
  parent.live |= 1u << slot;
  parent.filled = parent.live;
  own.back().parent = static_cast<std::uint32_t>(above.size() - 1);
  own.back().slot = static_cast<std::uint32_t>(slot);
}

/// The nodes along the curve, sixteen a parent, parents and roots of one face each.
void plant(ForestScratch& s, RayForest& out) {
  radix_sort(s.node_keys.keys, s.node_keys);
  for (auto& level : out.levels) level.clear();
  out.faces.clear(), out.root_boxes.clear();
  out.levels[0].reserve(s.nodes.size());
  for (const std::uint64_t key : s.node_keys.keys) {
    const std::uint8_t face = s.node_faces[place_of(key)];
    const bool new_face = out.faces.empty() || out.faces.back() != face;
    const bool new_parent = new_face || out.levels[1].back().live == 0xffffu;
    const bool new_root = new_face || (new_parent && out.levels[2].back().live == 0xffffu);
    out.levels[0].push_back(s.nodes[place_of(key)]);
    append(out, 0, new_parent);
    if (new_parent) append(out, 1, new_root);
    if (new_root) out.faces.push_back(face);
  }
  for (std::size_t level = 0; level + 1 < ray_levels; ++level) {
    for (const RayNode& node : out.levels[level])
      out.levels[level + 1][node.parent].set_box(static_cast<int>(node.slot), bounds_of(node));
  }
  for (const RayNode& root : out.levels[2]) out.root_boxes.push_back(bounds_of(root));
}

/// Four pixels by the bits of `live`; returns how many are set.
std::uint32_t write_row(std::uint32_t live, std::uint8_t* to) {
  if (live == 15u) {  // no other tile holds rays of this row: four bytes at once
    std::memset(to, 255, 4);
    return 4;
  }
  std::uint32_t count = 0;
  for (; live != 0; live &= live - 1, ++count) to[std::countr_zero(live)] = 255;
  return count;
}

}  // namespace

FaceBox bounds_of(const RayNode& node) {
  FaceBox box{infinity, -infinity, infinity, -infinity, infinity, 0};
  for (std::uint32_t live = node.live; live != 0; live &= live - 1)
    widen(box, node.box(std::countr_zero(live)));
  return box;
}

std::size_t RayForest::byte_count() const {
  std::size_t bytes = tiles.size() * (sizeof(RayTile) + sizeof(TileRays));
  for (const auto& level : levels) bytes += level.size() * sizeof(RayNode);
  return bytes;
}

void build_ray_forest(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                      const ShadowLight& light, const RaySource& source, const HardShadowConfig& config,
                      ForestScratch& scratch, RayForest& out) {
  const SquareGrid grid(points.width, points.height);
  const std::size_t slots = static_cast<std::size_t>(grid.columns) * grid.rows * square_tiles;
  out.tiles.resize(slots);
  scratch.rows.resize(grid.rows);
  const SquareSorter sorter(points, view, triangles, light, source, config);
  parallel_tasks(static_cast<int>(grid.rows), [&](int row) {
    sorter.sort_row(static_cast<std::uint32_t>(row), out.tiles, scratch.rows[static_cast<std::size_t>(row)]);
  });
  gather_rows(slots, scratch, out);
  out.tile_rays.resize(out.tiles.size());
  if (!out.in_range) return;
  group_loose(scratch);
  plant(scratch, out);
}

TileCounts write_live_rays(const RayForest& forest, std::size_t width, ShadowMask& mask) {
  constexpr std::size_t grain = 1 << 12;
  std::vector<TileCounts> parts((forest.tiles.size() + grain - 1) / grain);
  parallel_ranges(forest.tiles.size(), grain, [&](std::size_t first, std::size_t last) {
    TileCounts& counts = parts[first / grain];
    for (std::size_t i = first; i < last; ++i) {
      const RayTile& tile = forest.tiles[i];
      counts.tests += tile.tests;
      if (tile.live == 0) continue;
      for (std::size_t row = 0; row < tile_side; ++row)
        counts.live += write_row((tile.live >> (4 * row)) & 15u, &mask[tile.pixel] + row * width);
    }
  });
  TileCounts sum;
  for (const TileCounts& part : parts) sum.live += part.live, sum.tests += part.tests;
  return sum;
}

}  // namespace tenebra
