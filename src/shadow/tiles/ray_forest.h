// The rays of one light as the variant Tiles sees them: tiles of up to sixteen neighbouring pixels, and over
// them three levels of sixteen-way nodes bounded by boxes on the faces of a cube around the light.
//
// On a face with the axis z a point p (relative to the light) has the coordinates u = x/z, v = y/z, w = 1/z.
// Rays are points of (u, v), a triangle with corners z > 0 is a triangle there, and of all that lies over a
// ray the nearer to the light has the larger w. A box of (u, v, smallest w) is thus a cone of rectangular
// section with its apex at the light, and sixteen of them are tested in a few instructions. A face serves all
// rays with |u|, |v| <= face_limit, so that few tiles straddle two. Of directional and of far lights all rays
// are on one face more: distant_face.h.
//
// The points come in tiles of 4x4 pixels, with boxes around them (points/point_tiles.h): of most squares
// nothing more is read before a triangle comes near them (of lights with a range or a cone, and of tiles that
// straddle gaps or are wide, their points too). A square of sixteen tiles without depth gaps is a
// node of the lowest level as it stands, unless it is wide as seen from the light; the groups of the others
// are sorted along a Hilbert curve on the cube and joined anew. The nodes are then sorted along the same
// curve: thousands of them, where sorting all rays is a million.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>
#include "points/point_tiles.h"
#include "shadow/decision/triangle_planes.h"
#include "shadow/rays/shadow_rays.h"
#include "shadow/tiles/distant_face.h"

namespace tenebra::shadow {

inline constexpr float face_limit = 3;

/// Bounds on a face, widened so that boxes of triangles computed in float (relative error 5u) need no margin
/// of their own.
struct FaceBox {
  float u0, u1, v0, v1;
  float w;       ///< smallest; of triangles the largest
  float w1 = 0;  ///< largest, of rays
};

/// Sixteen children: groups of a tile's rays (level 0), or nodes of the level below.
struct alignas(64) RayNode {
  float u0[16], u1[16], v0[16], v1[16], w[16], w1[16];
  std::uint32_t child[16];     ///< level 0: number of the tile
  std::uint32_t own[16];       ///< level 0: triangle that all points lie on; no_triangle: several
  std::uint16_t rays[16];      ///< level 0: lanes of the tile with a ray that is not yet blocked
  std::uint16_t all_rays[16];  ///< level 0: lanes that had a ray
  float tau = 0;               ///< level 0: largest rounding tolerance of the points' triangles
  std::uint32_t live = 0;      ///< bit i: child i has rays left
  std::uint32_t filled = 0;    ///< bit i: there is a child i
  std::uint32_t wide = 0;      ///< bit i: the box of child i may be wider than its rays
  std::uint32_t parent = 0;    ///< node of the level above
  std::uint32_t slot = 0;      ///< among its children
  std::uint32_t tests = 0;     ///< triangles and boxes that its children were tested with

  FaceBox box(int i) const { return {u0[i], u1[i], v0[i], v1[i], w[i], w1[i]}; }
  void set_box(int i, const FaceBox& b) {
    u0[i] = b.u0, u1[i] = b.u1, v0[i] = b.v0, v1[i] = b.v1, w[i] = b.w, w1[i] = b.w1;
  }
};

/// Smallest box around all children that have rays.
FaceBox bounds_of(const RayNode& node);

inline constexpr int ray_levels = 3;
struct RayForest {
  /// [0]: over tiles, patch_squares to a patch as far as needed (others are empty), then those joined of
  /// loose groups; [2]: the roots.
  std::array<std::vector<RayNode>, ray_levels> levels;
  std::vector<std::uint8_t> faces;     ///< of each root: axis * 2, + 1 for the negative side; or distant
  std::optional<DistantFace> distant;  ///< then all roots are of that face
  std::vector<FaceBox> root_boxes;
  std::vector<std::uint32_t> at_light;  ///< pixels whose point is the light: lit
  std::uint64_t rays = 0;
  float tau = 0;         ///< largest of the tiles'
  bool in_range = true;  ///< distant, or all points are 1e-15 ... 1e15 from the light; else not to be used

  std::size_t byte_count() const;
};

/// Scratch of build_ray_forest.
struct ForestScratch {
  struct Loose {
    std::uint32_t tile;
    std::uint32_t own;
    std::uint16_t rays;
    float tau;
    FaceBox box;
  };
  struct Patch {  ///< what one patch of points gave
    std::vector<std::uint8_t> facing;
    RayNode* nodes = nullptr;  ///< room for patch_squares in level 0, from `first` on
    FaceBox* boxes = nullptr;  ///< of these nodes
    std::size_t first = 0;
    std::size_t count = 0;
    std::vector<std::uint32_t> node_keys;
    std::vector<Loose> loose;
    std::vector<std::uint32_t> loose_keys;
    std::size_t first_key = 0, first_loose_key = 0;  ///< among those of all patches
    std::vector<std::uint32_t> at_light;
    std::uint64_t rays = 0;
    float tau = 0;
    bool in_range = true;

    void clear();
  };
  std::vector<Patch> patches;
  std::vector<FaceBox> boxes;  ///< of the nodes of level 0
  RayKeys node_keys, loose_keys;
  std::vector<std::size_t> begins;
  std::vector<std::uint8_t> faces;  ///< of the nodes of level 1
};

/// `tiles`: of `points`. Distant or not is what `out` says; `source`: with positions relative to that face's
/// origin. Directional lights have to be distant.
void build_ray_forest(const VisiblePoints& points, const points::PointTiles& tiles,
                      const TriangleView& triangles, const ShadowLight& light, const RaySource& source,
                      const HardShadowConfig& config, ForestScratch& scratch, RayForest& out);

/// 255 where rays are left; the mask is zero elsewhere. Returns their number.
/// `parts`: room.
std::uint64_t write_live_rays(const RayForest& forest, int width, int height,
                              std::vector<std::uint64_t>& parts, ShadowMask& mask);

}  // namespace tenebra::shadow
