// The rays of one light as the variant Tiles sees them: tiles of up to sixteen neighbouring pixels, and over
// them three levels of sixteen-way nodes bounded by boxes on the faces of a cube around the light.
//
// On a face with the axis z a point p (relative to the light) has the coordinates u = x/z, v = y/z, w = 1/z.
// Rays are points of (u, v), a triangle with corners z > 0 is a triangle there, and of all that lies over a
// ray the nearer to the light has the larger w. A box of (u, v, smallest w) is thus a cone of rectangular
// section with its apex at the light, and sixteen of them are tested in a few instructions. A face serves all
// rays with |u|, |v| <= face_limit, so that few tiles straddle two.
//
// A square of 16x16 pixels without depth gaps is a node of the lowest level as it stands; the tiles of the
// others, split at the gaps, are sorted along a Hilbert curve on the cube and grouped anew. The nodes are
// then sorted along the same curve: thousands of them, where sorting all rays is a million.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "shadow/mask.h"
#include "shadow/shadow_rays.h"
#include "shadow/triangle_planes.h"

namespace tenebra {

inline constexpr int tile_side = 4, tile_rays = 16;
inline constexpr int square_tiles = 16;  ///< tiles of a square of 16x16 pixels
inline constexpr float face_limit = 3;

/// Up to sixteen rays; lane i is pixel + i % 4 + i / 4 * width. What is asked of a tile again and again.
struct RayTile {
  std::uint32_t pixel;   ///< of lane 0
  std::uint32_t live;    ///< bit i: a ray is there and not yet blocked
  std::uint32_t rays;    ///< bits of the lanes that had a ray
  std::uint32_t tests;   ///< triangles that the tile was tested with
  std::uint32_t own;     ///< triangle that all points lie on; no_triangle: several
  float tau;             ///< largest rounding tolerance of the points' own triangles
  std::uint64_t owners;  ///< bit id % 64 of all triangles that points lie on
  bool loaded;           ///< its TileRays are there
};

/// The rays of a tile, made when the first triangle comes near them: many tiles are never asked. Point i =
/// base + q_i relative to the light, q rounded to float, 0 in lanes without a ray.
struct alignas(64) TileRays {
  float qx[tile_rays], qy[tile_rays], qz[tile_rays];
  double base[3];
  float radius;  ///< >= largest |q|
  float reach;   ///< >= largest |point|
};

/// Bounds on a face, widened so that boxes of triangles computed in float (relative error 5u) need no margin
/// of their own.
struct FaceBox {
  float u0, u1, v0, v1;
  float w;       ///< smallest; of triangles the largest
  float w1 = 0;  ///< largest, of rays
};

/// Sixteen children: tiles (level 0), or nodes of the level below.
struct alignas(64) RayNode {
  float u0[16], u1[16], v0[16], v1[16], w[16], w1[16];
  std::uint32_t child[16];
  std::uint32_t own[16];     ///< level 0: RayTile::own of the tiles
  std::uint32_t live = 0;    ///< bit i: child i has rays left
  std::uint32_t filled = 0;  ///< bit i: there is a child i
  std::uint32_t parent = 0;  ///< node of the level above
  std::uint32_t slot = 0;    ///< among its children
  std::uint32_t tests = 0;   ///< triangles and boxes that its children were tested with

  FaceBox box(int i) const { return {u0[i], u1[i], v0[i], v1[i], w[i], w1[i]}; }
  void set_box(int i, const FaceBox& b) {
    u0[i] = b.u0, u1[i] = b.u1, v0[i] = b.v0, v1[i] = b.v1, w[i] = b.w, w1[i] = b.w1;
  }
};

/// Smallest box around all children that have rays.
FaceBox bounds_of(const RayNode& node);

inline constexpr int ray_levels = 3;
struct RayForest {
  std::vector<RayTile> tiles;
  std::vector<TileRays> tile_rays;                      ///< one a tile
  std::array<std::vector<RayNode>, ray_levels> levels;  ///< [0]: over tiles; [2]: the roots
  std::vector<std::uint8_t> faces;                      ///< of each root: axis * 2, + 1 for the negative side
  std::vector<FaceBox> root_boxes;
  std::vector<std::uint32_t> at_light;  ///< pixels whose point is the light: lit
  std::uint64_t rays = 0;
  float tau = 0;         ///< largest of the tiles'
  bool in_range = true;  ///< all points are 1e-15 ... 1e15 from the light; else the forest is not to be used

  std::size_t byte_count() const;
};

/// Scratch of build_ray_forest.
struct ForestScratch {
  struct Loose {
    std::uint32_t tile;
    std::uint32_t own;
    std::uint8_t face;
    FaceBox box;
  };
  struct Row {                   ///< what one row of squares gave
    std::vector<RayTile> split;  ///< tiles beyond the sixteen of a square
    std::vector<RayNode> nodes;
    std::vector<std::uint8_t> node_faces;
    std::vector<std::uint32_t> node_keys;
    std::vector<Loose> loose;
    std::vector<std::uint32_t> loose_keys;
    std::vector<std::uint32_t> at_light;
    std::uint64_t rays = 0;
    float tau = 0;
    bool in_range = true;
  };
  std::vector<Row> rows;
  std::vector<Loose> loose;
  std::vector<std::uint8_t> node_faces;
  std::vector<RayNode> nodes;
  RayKeys node_keys, loose_keys;
};

/// Point and spot lights.
void build_ray_forest(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                      const ShadowLight& light, const RaySource& source, const HardShadowConfig& config,
                      ForestScratch& scratch, RayForest& out);

struct TileCounts {
  std::uint64_t live = 0;   ///< rays left
  std::uint64_t tests = 0;  ///< sum of RayTile::tests
};
/// 255 where rays are left; the mask is zero elsewhere.
TileCounts write_live_rays(const RayForest& forest, std::size_t width, ShadowMask& mask);

}  // namespace tenebra
