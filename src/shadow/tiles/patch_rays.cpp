#include "shadow/tiles/patch_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::dvec3;

// A square is a node as it stands if it is at most this many times as wide as its tiles are on the mean: 4
// for a flat patch, with room for perspective and curvature.
constexpr float coherent_extent = 8;

std::uint8_t face_of(const dvec3& p) {
  const double x = std::abs(p.x), y = std::abs(p.y), z = std::abs(p.z), largest = std::max({x, y, z});
  const int axis = largest <= x ? 0 : largest <= y ? 1 : 2;
  return static_cast<std::uint8_t>(2 * axis + (p[axis] < 0 ? 1 : 0));
}

/// Box of a single point on its own face, with the margins of TileKernels::project.
FaceBox box_of(const dvec3& p, std::uint8_t face) {
  const int axis = face / 2;
  const double z = std::abs(p[axis]);
  constexpr float u = 0x1p-24f;
  const auto pu = static_cast<float>(p[(axis + 1) % 3] / z), pv = static_cast<float>(p[(axis + 2) % 3] / z);
  const auto w = static_cast<float>(1 / z);
  return {pu - 32 * u, pu + 32 * u, pv - 32 * u, pv + 32 * u, w * (1 - 16 * u), w * (1 + 16 * u)};
}

}  // namespace

/// Curve keys, worked out sixteen at a time.
struct PatchRays::Keys {
  Keys(const RayKernels& k, std::vector<std::uint32_t>& to) : kernels(k), out(to) {}
  const RayKernels& kernels;
  std::vector<std::uint32_t>& out;
  float x[16] = {}, y[16] = {}, z[16] = {};
  std::uint8_t faces[16] = {};
  int size = 0;

  void add(const dvec3& p, std::uint8_t face) {
    x[size] = static_cast<float>(p.x), y[size] = static_cast<float>(p.y), z[size] = static_cast<float>(p.z);
    faces[size] = face;
    if (++size == 16) flush();
  }
  void flush() {
    std::uint32_t keys[16];
    kernels.direction_keys(x, y, z, keys);
    for (int i = 0; i < size; ++i)
      out.push_back((keys[i] & 0x0fffffffu) | static_cast<std::uint32_t>(faces[i]) << 28);
    size = 0;
  }
};

/// A block and where its rays go.
struct PatchRays::Work {
  Work(const RayKernels& kernels, ForestScratch::Patch& to)
      : out(to), node_keys(kernels, to.node_keys), loose_keys(kernels, to.loose_keys) {}
  ForestScratch::Patch& out;
  Keys node_keys, loose_keys;
  const PointBlock* block = nullptr;
  std::uint16_t rays[16] = {};
  std::uint32_t present = 0;  ///< bits of groups with rays
  RayNode node;               ///< boxes
};

PatchRays::PatchRays(const VisiblePoints& points, const PointTiles& tiles, const TriangleView& triangles,
                     const ShadowLight& light, const RaySource& source, const HardShadowConfig& config)
    : points_(points),
      tiles_(tiles),
      triangles_(triangles),
      light_(light),
      source_(source),
      pixels_(points.width, points.height),
      bounded_(light.range_m > 0 || light.spot_cos_outer > -1),
      kernels_(tile_kernels(config.simd)),
      ray_kernels_(ray_kernels(config.simd)) {}

std::size_t PatchRays::pixel_at(std::uint32_t tile, int lane) const {
  return pixels_(tile) + static_cast<std::size_t>(lane / 4) * static_cast<std::size_t>(points_.width) +
         static_cast<std::size_t>(lane % 4);
}

/// About the middle of a group, relative to the light.
dvec3 PatchRays::centre_of(const PointBlock& block, int group) const {
  dvec3 centre;
  for (int k = 0; k < 3; ++k) {
    centre[k] = static_cast<double>(block.base[k]) - source_.origin[k] +
                0.5 * static_cast<double>(block.low[k][group]) + 0.5 * static_cast<double>(block.high[k][group]);
  }
  return centre;
}

/// For each receiver 1: the light is on the eye's side.
void PatchRays::find_facing(const PointPatch& patch, std::vector<std::uint8_t>& facing) const {
  facing.resize(patch.receivers.size() * 16);
  for (std::size_t b = 0; b < patch.receivers.size(); ++b) {
    const ReceiverBlock& block = patch.receivers[b];
    Facing found = kernels_.facing(block, source_.light);
    for (std::uint32_t i = 0; i < 16; ++i) {
      const std::size_t number = b * 16 + i;
      if (((found.open >> i) & 1u) != 0 && number < patch.receiver_count) {
        const int side = light_side(corners_of(triangles_, block.id[i]).v, source_);
        found.facing |= side == -block.side[i] ? 1u << i : 0u;
      }
      facing[number] = static_cast<std::uint8_t>((found.facing >> i) & 1u);
    }
  }
}

std::uint32_t PatchRays::facing_lanes(const PointBlock& block, int group,
                                      const std::vector<std::uint8_t>& facing) const {
  const std::uint32_t lanes = block.lanes[group];
  if (block.receiver[group] != several_receivers) return facing[block.receiver[group]] != 0 ? lanes : 0;
  const PointTile& tile = tiles_.tiles[block.tile[group]];
  std::uint32_t faced = 0;
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    faced |= static_cast<std::uint32_t>(facing[tile.receiver[lane]]) << lane;
  }
  return faced;
}

std::uint32_t PatchRays::in_reach_lanes(std::uint32_t tile, std::uint32_t lanes) const {
  std::uint32_t reached = lanes;
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    if (!in_reach(points_.positions[pixel_at(tile, lane)] - source_.origin, light_)) reached &= ~(1u << lane);
  }
  return reached;
}

/// False: too wide; nothing is done.
bool PatchRays::add_node(Work& work, std::uint32_t groups, std::uint8_t face) const {
  RayNode& node = work.node;
  node.live = node.filled = groups;
  const FaceBox all = bounds_of(node);
  float wide = 0, high = 0;
  for (std::uint32_t left = groups; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    wide += node.u1[i] - node.u0[i], high += node.v1[i] - node.v0[i];
  }
  const float scale = coherent_extent / static_cast<float>(std::popcount(groups));
  if (all.u1 - all.u0 > wide * scale || all.v1 - all.v0 > high * scale) return false;
  for (int i = 0; i < 16; ++i) {
    node.child[i] = work.block->tile[i];
    node.own[i] = work.block->own[i];
    node.rays[i] = node.all_rays[i] = work.rays[i];
  }
  work.out.nodes.push_back(node);
  work.out.node_faces.push_back(face);
  work.node_keys.add(centre_of(*work.block, std::countr_zero(groups)), face);
  return true;
}

void PatchRays::add_loose(Work& work, int group, std::uint8_t face) const {
  const PointBlock& block = *work.block;
  work.out.loose.push_back(
      {block.tile[group], block.own[group], work.rays[group], face, work.node.box(group)});
  work.loose_keys.add(centre_of(block, group), face);
}

/// A group whose box reaches beyond all faces, or to the light: its points one by one.
void PatchRays::add_single_rays(Work& work, int group) const {
  const std::uint32_t tile = work.block->tile[group];
  for (std::uint32_t left = work.rays[group]; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    const std::size_t pixel = pixel_at(tile, lane);
    const dvec3 p = points_.positions[pixel] - source_.origin;
    const double size = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (size == 0) {
      work.out.at_light.push_back(static_cast<std::uint32_t>(pixel));
      --work.out.rays;
      continue;
    }
    work.out.in_range &= size > shortest_ray && size < longest_ray;
    const std::uint8_t face = face_of(p);
    work.out.loose.push_back(
        {tile, work.block->own[group], static_cast<std::uint16_t>(1u << lane), face, box_of(p, face)});
    work.loose_keys.add(p, face);
  }
}

/// Puts the groups with rays on faces, as many as can be on one at a time.
void PatchRays::place_block(Work& work) const {
  std::uint32_t left = work.present;
  while (left != 0) {
    const int first = std::countr_zero(left);
    const std::uint8_t face = face_of(centre_of(*work.block, first));
    const std::uint32_t on = kernels_.project(*work.block, source_.origin, face, work.node) & left;
    if (((on >> first) & 1u) == 0) {
      add_single_rays(work, first);
      left &= left - 1;
      continue;
    }
    left &= ~on;
    if (work.block->whole && on == work.present && add_node(work, on, face)) return;
    for (std::uint32_t loose = on; loose != 0; loose &= loose - 1)
      add_loose(work, std::countr_zero(loose), face);
  }
}

void PatchRays::find(const PointPatch& patch, ForestScratch::Patch& out) const {
  out.clear();
  find_facing(patch, out.facing);
  Work work(ray_kernels_, out);
  for (const PointBlock& block : patch.blocks) {
    work.block = &block;
    work.present = 0;
    for (std::uint32_t left = block.filled; left != 0; left &= left - 1) {
      const int group = std::countr_zero(left);
      std::uint32_t lanes = facing_lanes(block, group, out.facing);
      if (bounded_ && lanes != 0) lanes = in_reach_lanes(block.tile[group], lanes);
      work.rays[group] = static_cast<std::uint16_t>(lanes);
      if (lanes != 0) work.present |= 1u << group;
      out.rays += static_cast<std::uint64_t>(std::popcount(lanes));
    }
    if (work.present == 0) continue;
    out.tau = std::max(out.tau, block.tau);
    double farthest = block.radius;
    for (int k = 0; k < 3; ++k)
      farthest = std::max(farthest, std::abs(static_cast<double>(block.base[k]) - source_.origin[k]) +
                                        static_cast<double>(block.radius));
    out.in_range &= farthest < longest_ray;
    if (out.in_range) place_block(work);
  }
  work.node_keys.flush();
  work.loose_keys.flush();
}

}  // namespace tenebra
