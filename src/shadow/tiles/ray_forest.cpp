#include "shadow/tiles/ray_forest.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "parallel/parallel.h"
#include "shadow/tiles/patch_rays.h"

namespace tenebra {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

void widen(FaceBox& to, const FaceBox& by) {
  to.u0 = std::min(to.u0, by.u0), to.u1 = std::max(to.u1, by.u1);
  to.v0 = std::min(to.v0, by.v0), to.v1 = std::max(to.v1, by.v1);
  to.w = std::min(to.w, by.w), to.w1 = std::max(to.w1, by.w1);
}

std::uint32_t place_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}
/// Keys have the face above the place on its curve.
std::uint8_t face_of(std::uint64_t key) {
  return static_cast<std::uint8_t>(key >> 60);
}
std::uint64_t key_of(std::uint32_t curve, std::size_t place) {
  return static_cast<std::uint64_t>(curve) << 32 | place;
}

/// Gathers what the patches gave, in their order, so that nothing depends on threads.
void gather_patches(ForestScratch& s, RayForest& out) {
  s.loose.clear();
  s.boxes.resize(out.levels[0].size());
  s.node_keys.keys.clear(), s.loose_keys.keys.clear();
  out.at_light.clear();
  out.rays = 0;
  out.tau = 0;
  out.in_range = true;
  for (const ForestScratch::Patch& patch : s.patches) {
    for (std::size_t i = 0; i < patch.count; ++i) {
      s.node_keys.keys.push_back(key_of(patch.node_keys[i], patch.first + i));
      s.boxes[patch.first + i] = patch.boxes[i];
    }
    for (std::size_t i = 0; i < patch.loose.size(); ++i) {
      s.loose_keys.keys.push_back(key_of(patch.loose_keys[i], s.loose.size()));
      s.loose.push_back(patch.loose[i]);
    }
    out.at_light.insert(out.at_light.end(), patch.at_light.begin(), patch.at_light.end());
    out.rays += patch.rays;
    out.tau = std::max(out.tau, patch.tau);
    out.in_range &= patch.in_range;
  }
}

/// Loose groups in the order of the curve become nodes of sixteen on one face, with the key of their first.
void group_loose(ForestScratch& s, std::vector<RayNode>& nodes) {
  radix_sort(s.loose_keys.keys, s.loose_keys);
  const auto& keys = s.loose_keys.keys;
  for (std::size_t i = 0; i < keys.size();) {
    const std::uint8_t face = face_of(keys[i]);
    s.node_keys.keys.push_back(key_of(static_cast<std::uint32_t>(keys[i] >> 32), nodes.size()));
    RayNode& node = nodes.emplace_back();
    for (int k = 0; k < 16 && i < keys.size() && face_of(keys[i]) == face; ++k, ++i) {
      const ForestScratch::Loose& loose = s.loose[place_of(keys[i])];
      node.child[k] = loose.tile;
      node.own[k] = loose.own;
      node.rays[k] = node.all_rays[k] = loose.rays;
      node.tau = std::max(node.tau, loose.tau);
      node.set_box(k, loose.box);
      node.live |= 1u << k;
    }
    node.filled = node.live;
    s.boxes.push_back(bounds_of(node));
  }
}

/// Makes node `child` of level `level` one of the last node of the level above, or of a new one.
void append(RayForest& f, std::size_t level, std::size_t child, bool fresh) {
  auto& above = f.levels[level + 1];
  if (fresh) above.emplace_back();
  RayNode& parent = above.back();
  const int slot = std::popcount(parent.live);
  parent.child[slot] = static_cast<std::uint32_t>(child);
  parent.live |= 1u << slot;
  parent.filled = parent.live;
  f.levels[level][child].parent = static_cast<std::uint32_t>(above.size() - 1);
  f.levels[level][child].slot = static_cast<std::uint32_t>(slot);
}

/// The nodes along the curve, sixteen a parent, parents and roots of one face each. They stay where they are.
void plant(ForestScratch& s, RayForest& out) {
  radix_sort(s.node_keys.keys, s.node_keys);
  out.levels[1].clear(), out.levels[2].clear();
  out.faces.clear(), out.root_boxes.clear();
  for (const std::uint64_t key : s.node_keys.keys) {
    const bool new_face = out.faces.empty() || out.faces.back() != face_of(key);
    const bool new_parent = new_face || out.levels[1].back().live == 0xffffu;
    const bool new_root = new_face || (new_parent && out.levels[2].back().live == 0xffffu);
    append(out, 0, place_of(key), new_parent);
    RayNode& parent = out.levels[1].back();
    parent.set_box(std::popcount(parent.live) - 1, s.boxes[place_of(key)]);
    if (new_parent) append(out, 1, out.levels[1].size() - 1, new_root);
    if (new_root) out.faces.push_back(face_of(key));
  }
  for (const RayNode& node : out.levels[1])
    out.levels[2][node.parent].set_box(static_cast<int>(node.slot), bounds_of(node));
  for (const RayNode& root : out.levels[2]) out.root_boxes.push_back(bounds_of(root));
}

/// Whether a node is a whole square without a blocked ray.
bool all_lit(const RayNode& node) {
  if (node.live != 0xffffu || node.child[0] % 16 != 0 || node.child[15] != node.child[0] + 15) return false;
  std::uint32_t all = 0xffffu;
  for (int i = 0; i < 16; ++i)
    all &= node.child[i] == node.child[0] + static_cast<std::uint32_t>(i) ? node.rays[i] : 0u;
  return all == 0xffffu;
}

void write_square(std::uint8_t* to, int width) {
  for (std::uint32_t row = 0; row < square_side; ++row, to += width) std::memset(to, 255, square_side);
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

void ForestScratch::Patch::clear() {
  count = 0;
  boxes.clear(), node_keys.clear();
  loose.clear(), loose_keys.clear(), at_light.clear();
  rays = 0;
  tau = 0;
  in_range = true;
}

std::size_t RayForest::byte_count() const {
  std::size_t bytes = 0;
  for (const auto& level : levels) bytes += level.size() * sizeof(RayNode);
  return bytes;
}

void build_ray_forest(const VisiblePoints& points, const PointTiles& tiles, const TriangleView& triangles,
                      const ShadowLight& light, const RaySource& source, const HardShadowConfig& config,
                      ForestScratch& scratch, RayForest& out) {
  scratch.patches.resize(tiles.patches.size());
  const std::size_t slots = tiles.patches.size() * patch_squares;
  out.levels[0].resize(slots);
  const PatchRays rays(points, tiles, triangles, light, source, config);
  parallel_tasks(static_cast<int>(tiles.patches.size()), [&](int patch) {
    const auto i = static_cast<std::size_t>(patch);
    scratch.patches[i].first = i * patch_squares;
    scratch.patches[i].nodes = &out.levels[0][i * patch_squares];
    rays.find(tiles.patches[i], scratch.patches[i]);
  });
  gather_patches(scratch, out);
  if (!out.in_range) return;
  group_loose(scratch, out.levels[0]);
  plant(scratch, out);
}

std::uint64_t write_live_rays(const RayForest& forest, int width, int height, ShadowMask& mask) {
  constexpr std::size_t grain = 256;
  const std::vector<RayNode>& nodes = forest.levels[0];
  const TilePixels pixel_of(width, height);
  std::vector<std::uint64_t> parts((nodes.size() + grain - 1) / grain);
  parallel_ranges(nodes.size(), grain, [&](std::size_t first, std::size_t last) {
    std::uint64_t count = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (all_lit(nodes[i])) {
        write_square(&mask[pixel_of(nodes[i].child[0])], width);
        count += 256;
        continue;
      }
      for (std::uint32_t left = nodes[i].live; left != 0; left &= left - 1) {
        const int slot = std::countr_zero(left);
        std::uint8_t* to = &mask[pixel_of(nodes[i].child[slot])];
        for (std::uint32_t row = 0; row < tile_side; ++row, to += width)
          count += write_row((nodes[i].rays[slot] >> (4 * row)) & 15u, to);
      }
    }
    parts[first / grain] = count;
  });
  std::uint64_t sum = 0;
  for (const std::uint64_t part : parts) sum += part;
  return sum;
}

}  // namespace tenebra
