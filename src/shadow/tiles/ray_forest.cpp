#include "shadow/tiles/ray_forest.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "parallel/parallel.h"
#include "shadow/tiles/patch_rays.h"
#include "simd/prefetch.h"

namespace tenebra::shadow {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

void widen(FaceBox& to, const FaceBox& by) {
  to.u0 = std::min(to.u0, by.u0), to.u1 = std::max(to.u1, by.u1);
  to.v0 = std::min(to.v0, by.v0), to.v1 = std::max(to.v1, by.v1);
  to.w = std::min(to.w, by.w), to.w1 = std::max(to.w1, by.w1);
}

// A key, from the highest bits on: face, place on its curve, and 32 bits that number what has the key.
std::uint32_t place_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}
std::uint8_t face_of(std::uint64_t key) {
  return static_cast<std::uint8_t>(key >> 60);
}
std::uint64_t key_of(std::uint32_t curve, std::size_t place) {
  return static_cast<std::uint64_t>(curve) << 32 | place;
}
// The number of a loose group: its patch, and in the low 16 bits its place there.
static_assert(points::patch_squares * 256 <= 0x10000);
std::size_t loose_place(std::size_t patch, std::size_t i) {
  return patch << 16 | i;
}

/// Gathers what the patches gave, in their order, so that nothing depends on threads.
void gather_patches(ForestScratch& s, RayForest& out) {
  std::size_t nodes = 0, loose = 0;
  out.at_light.clear();
  out.rays = 0;
  out.tau = 0;
  out.in_range = true;
  for (ForestScratch::Patch& patch : s.patches) {
    patch.first_key = nodes, patch.first_loose_key = loose;
    nodes += patch.count, loose += patch.loose.size();
    out.at_light.insert(out.at_light.end(), patch.at_light.begin(), patch.at_light.end());
    out.rays += patch.rays;
    out.tau = std::max(out.tau, patch.tau);
    out.in_range &= patch.in_range;
  }
  s.node_keys.keys.resize(nodes), s.loose_keys.keys.resize(loose);
  parallel::parallel_tasks(static_cast<int>(s.patches.size()), [&](int p) {
    const auto number = static_cast<std::size_t>(p);
    const ForestScratch::Patch& patch = s.patches[number];
    for (std::size_t i = 0; i < patch.count; ++i)
      s.node_keys.keys[patch.first_key + i] = key_of(patch.node_keys[i], patch.first + i);
    for (std::size_t i = 0; i < patch.loose.size(); ++i)
      s.loose_keys.keys[patch.first_loose_key + i] = key_of(patch.loose_keys[i], loose_place(number, i));
  });
}

/// Where nodes begin among children in order: up to sixteen each, all of one face; the last entry is the end.
template <class FaceOf>
void cut_into_nodes(std::size_t count, const FaceOf& face_of_child, std::vector<std::size_t>& begins) {
  begins.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || i - begins.back() == 16 || face_of_child(i) != face_of_child(begins.back()))
      begins.push_back(i);
  }
  begins.push_back(count);
}

constexpr std::size_t grain = 32;  // nodes that are made together

/// Loose groups in the order of the curve become nodes, with the key of their first.
void group_loose(ForestScratch& s, std::vector<RayNode>& nodes) {
  radix_sort(s.loose_keys.keys, s.loose_keys);
  const auto& keys = s.loose_keys.keys;
  cut_into_nodes(
      keys.size(), [&](std::size_t i) { return face_of(keys[i]); }, s.begins);
  const std::size_t count = s.begins.size() - 1, first = nodes.size(), first_key = s.node_keys.keys.size();
  nodes.resize(first + count), s.boxes.resize(first + count), s.node_keys.keys.resize(first_key + count);
  const auto loose_at = [&](std::size_t k) -> const ForestScratch::Loose& {
    const std::uint32_t place = place_of(keys[k]);
    return s.patches[place >> 16].loose[place & 0xffffu];
  };
  parallel::parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      RayNode& node = nodes[first + i] = {};
      for (std::size_t k = s.begins[i]; k < s.begins[i + 1]; ++k) {
        if (k + 16 < keys.size()) simd::prefetch(&loose_at(k + 16));
        const ForestScratch::Loose& loose = loose_at(k);
        const std::size_t slot = k - s.begins[i];
        node.child[slot] = loose.tile;
        node.own[slot] = loose.own;
        node.rays[slot] = node.all_rays[slot] = loose.rays;
        node.tau = std::max(node.tau, loose.tau);
        node.set_box(static_cast<int>(slot), loose.box);
        node.live |= 1u << slot;
      }
      node.filled = node.live;
      s.boxes[first + i] = bounds_of(node);
      s.node_keys.keys[first_key + i] =
          key_of(static_cast<std::uint32_t>(keys[s.begins[i]] >> 32), first + i);
    }
  });
}

/// The level above `level`, whose nodes child(0), child(1) ... are in order and have the boxes box(0) ...
template <class FaceOf, class Child, class Box>
void add_level(ForestScratch& s, RayForest& f, std::size_t level, std::size_t count,
               const FaceOf& face_of_child, const Child& child, const Box& box) {
  cut_into_nodes(count, face_of_child, s.begins);
  std::vector<RayNode>& above = f.levels[level + 1];
  above.resize(s.begins.size() - 1);
  parallel::parallel_ranges(above.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      RayNode& parent = above[i] = {};
      for (std::size_t k = s.begins[i]; k < s.begins[i + 1]; ++k) {
        const auto slot = static_cast<std::uint32_t>(k - s.begins[i]);
        parent.child[slot] = child(k);
        parent.set_box(static_cast<int>(slot), box(k));
        parent.live |= 1u << slot;
        f.levels[level][child(k)].parent = static_cast<std::uint32_t>(i);
        f.levels[level][child(k)].slot = slot;
      }
      parent.filled = parent.live;
    }
  });
}

/// Builds the two levels above the nodes, sixteen to a parent along the curve; parents and roots hold one
/// face each. The nodes stay where they are.
void plant(ForestScratch& s, RayForest& out) {
  radix_sort(s.node_keys.keys, s.node_keys);
  const auto& keys = s.node_keys.keys;
  add_level(
      s, out, 0, keys.size(), [&](std::size_t i) { return face_of(keys[i]); },
      [&](std::size_t i) { return place_of(keys[i]); },
      [&](std::size_t i) { return s.boxes[place_of(keys[i])]; });
  s.faces.clear();
  for (std::size_t i = 0; i + 1 < s.begins.size(); ++i) s.faces.push_back(face_of(keys[s.begins[i]]));
  add_level(
      s, out, 1, s.faces.size(), [&](std::size_t i) { return s.faces[i]; },
      [](std::size_t i) { return static_cast<std::uint32_t>(i); },
      [&](std::size_t i) { return bounds_of(out.levels[1][i]); });
  out.faces.clear(), out.root_boxes.clear();
  for (std::size_t i = 0; i < out.levels[2].size(); ++i) {
    out.faces.push_back(s.faces[s.begins[i]]);
    out.root_boxes.push_back(bounds_of(out.levels[2][i]));
  }
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
  for (std::uint32_t row = 0; row < points::square_side; ++row, to += width)
    std::memset(to, 255, points::square_side);
}

/// Sets the pixels of a tile whose bits in `live` are set, and touches no others: threads share tiles.
void write_tile(std::uint32_t live, std::uint8_t* to, int width) {
  if (live == 0xffffu) {
    for (std::uint32_t row = 0; row < points::tile_side; ++row, to += width)
      std::memset(to, 255, points::tile_side);
    return;
  }
  for (; live != 0; live &= live - 1) {
    const int lane = std::countr_zero(live);
    to[lane % 4 + lane / 4 * width] = 255;
  }
}

}  // namespace

FaceBox bounds_of(const RayNode& node) {
  FaceBox box{infinity, -infinity, infinity, -infinity, infinity, -infinity};
  for (std::uint32_t live = node.live; live != 0; live &= live - 1)
    widen(box, node.box(std::countr_zero(live)));
  return box;
}

void ForestScratch::Patch::clear() {
  count = 0;
  node_keys.clear();
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

void build_ray_forest(const VisiblePoints& points, const points::PointTiles& tiles,
                      const TriangleView& triangles, const ShadowLight& light, const RaySource& source,
                      const HardShadowConfig& config, ForestScratch& scratch, RayForest& out) {
  scratch.patches.resize(tiles.patches.size());
  const std::size_t slots = tiles.patches.size() * points::patch_squares;
  out.levels[0].resize(slots), scratch.boxes.resize(slots);
  const PatchRays rays(points, tiles, triangles, light, source, config,
                       out.distant ? &*out.distant : nullptr);
  parallel::parallel_tasks(static_cast<int>(tiles.patches.size()), [&](int patch) {
    const auto i = static_cast<std::size_t>(patch);
    scratch.patches[i].first = i * points::patch_squares;
    scratch.patches[i].nodes = &out.levels[0][i * points::patch_squares];
    scratch.patches[i].boxes = &scratch.boxes[i * points::patch_squares];
    rays.find(tiles.patches[i], scratch.patches[i]);
  });
  gather_patches(scratch, out);
  if (!out.in_range) return;
  group_loose(scratch, out.levels[0]);
  plant(scratch, out);
}

std::uint64_t write_live_rays(const RayForest& forest, int width, int height,
                              std::vector<std::uint64_t>& parts, ShadowMask& mask) {
  constexpr std::size_t grain = 256;
  const std::vector<RayNode>& nodes = forest.levels[0];
  const points::TilePixels pixel_of(width, height);
  parts.assign((nodes.size() + grain - 1) / grain, 0);
  parallel::parallel_ranges(nodes.size(), grain, [&](std::size_t first, std::size_t last) {
    std::uint64_t count = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (all_lit(nodes[i])) {
        write_square(&mask[pixel_of(nodes[i].child[0])], width);
        count += 256;
        continue;
      }
      for (std::uint32_t left = nodes[i].live; left != 0; left &= left - 1) {
        const int slot = std::countr_zero(left);
        const std::uint32_t live = nodes[i].rays[slot];
        write_tile(live, &mask[pixel_of(nodes[i].child[slot])], width);
        count += static_cast<std::uint64_t>(std::popcount(live));
      }
    }
    parts[first / grain] = count;
  });
  std::uint64_t sum = 0;
  for (const std::uint64_t part : parts) sum += part;
  return sum;
}

}  // namespace tenebra::shadow
