// The two trees descended together, compiled once per instruction set.
#include "shadow/tiles/descent.h"

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/tiles/descent.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "shadow/decide.h"
#include "shadow/tiles/cluster_planes-inl.h"
#include "shadow/tiles/face_tests-inl.h"
#include "shadow/tiles/tile_rays-inl.h"
#include "simd/pack-inl.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

namespace {

// Up to so many tiles meet a cluster one by one; with more each triangle looks for its own.
constexpr int few_tiles = 32;

/// A node of rays and its own bounds.
struct RayRef {
  int level;
  std::uint32_t node;
  FaceBox box;
};

class RootDescent {
public:
  RootDescent(const Descent& d, std::uint32_t root, DescentScratch& scratch, TraceStats& stats)
      : d_(d),
        face_(face_axes(d.forest.faces[root])),
        light_(d.source.light),
        skip_own_(d.contact == ContactRule::triangle_ids),
        scratch_(scratch),
        stats_(stats) {}

  void visit(std::size_t level, std::size_t number, const RayRef& rays);

private:
  RayNode& node(const RayRef& ref) { return node(ref.level, ref.node); }
  RayNode& node(int level, std::uint32_t number) {
    return d_.forest.levels[static_cast<std::size_t>(level)][number];
  }
  RayTile& tile(const RayNode& n, int slot) { return d_.forest.tiles[n.child[slot]]; }
  const TileRays& rays_of(RayTile& tile);

  void fetch_tiles(const RayNode& n, std::uint32_t slots) const;
  bool narrow(RayRef& rays, const FaceBox& box);
  void collect(int level, std::uint32_t number, const FaceBox& box, int& count);
  void meet_cluster(const TriangleCluster& cluster, const RayRef& rays, const FaceBox& box);
  void meet_tiles(const TriangleCluster& cluster, std::uint32_t ahead, const FaceBoxes& boxes);
  void meet_triangles(const TriangleCluster& cluster, const RayRef& rays, std::uint32_t left,
                      const FaceBoxes& boxes);
  void descend_triangle(int level, std::uint32_t number, const FaceTriangle& t, int lane, std::uint32_t id);
  std::uint32_t cover_tiles(RayNode& n, const FaceTriangle& t, std::uint32_t met, std::uint32_t id);
  void test_triangle(RayTile& tile, int lane, std::uint32_t id);
  void test_rays(RayTile& tile, const TileRays& rays, int lane, const float e0[4], float k, std::uint32_t id);
  /// Whether some of the points may lie on the triangle.
  bool may_own(const RayTile& tile, std::uint32_t id) const {
    return ((tile.owners >> (id % 64)) & 1u) != 0 && skip_own_;
  }
  void settle(RayTile& tile, std::uint32_t open, std::uint32_t id);
  std::uint32_t own_lanes(const RayTile& tile, std::uint32_t lanes, std::uint32_t id) const;
  std::size_t pixel_of(const RayTile& tile, int lane) const;
  void retire(int level, std::uint32_t number);

  const Descent& d_;
  const Face face_;
  const glm::vec3 light_;
  const bool skip_own_;  ///< a triangle never blocks its own points
  DescentScratch& scratch_;
  TraceStats& stats_;
};

// Asks for what tests read of the tiles, all at once.
void RootDescent::fetch_tiles(const RayNode& n, std::uint32_t slots) const {
  if ((slots & (slots - 1)) == 0) return;
  for (; slots != 0; slots &= slots - 1) {
    const std::uint32_t number = n.child[std::countr_zero(slots)];
    const RayTile& tile = d_.forest.tiles[number];
    const auto* at = reinterpret_cast<const char*>(&d_.forest.tile_rays[number]);
    for (std::size_t line = 0; line < sizeof(TileRays); line += 64) fetch_soon(at + line);
    if (tile.loaded) continue;
    const glm::dvec3* points = d_.points.positions.data() + tile.pixel;
    for (int row = 0; row < tile_side; ++row, points += d_.points.width) {
      fetch_soon(points);
      fetch_soon(reinterpret_cast<const char*>(points) + 64);
    }
  }
}

// Down to the deepest node that holds all rays which the box may meet; false: there are none.
bool RootDescent::narrow(RayRef& rays, const FaceBox& box) {
  for (;;) {
    RayNode& n = node(rays);
    n.tests += 1;
    const std::uint32_t met = children_met(n, box);
    if (met == 0) return false;
    if (rays.level == 0 || (met & (met - 1)) != 0) return true;
    const int slot = std::countr_zero(met);
    rays = {rays.level - 1, n.child[slot], n.box(slot)};
  }
}

const TileRays& RootDescent::rays_of(RayTile& tile) {
  TileRays& rays = d_.forest.tile_rays[static_cast<std::size_t>(&tile - d_.forest.tiles.data())];
  if (!tile.loaded) {
    const auto width = static_cast<std::uint32_t>(d_.points.width);
    load_tile_rays(TileRows(d_.points, tile.pixel % width, tile.pixel / width), d_.source.origin, tile.rays,
                   rays);
    tile.loaded = true;
  }
  return rays;
}

void RootDescent::visit(std::size_t level, std::size_t number, const RayRef& rays) {
  RayNode& n = node(rays);
  if (n.live == 0) return;
  n.tests += 1;
  FaceBoxes boxes;
  std::uint32_t met = project_boxes(d_.clusters.levels()[level][number], light_, face_, boxes);
  met &= boxes_met(boxes, rays.box);
  if (met == 0) return;
  alignas(64) float u0[16], u1[16], v0[16], v1[16], w[16];
  store(boxes.u0, u0), store(boxes.u1, u1), store(boxes.v0, v0), store(boxes.v1, v1), store(boxes.w, w);
  for (; met != 0; met &= met - 1) {
    const int i = std::countr_zero(met);
    const FaceBox box{u0[i], u1[i], v0[i], v1[i], w[i]};
    const std::size_t child = number * cluster_size + static_cast<std::size_t>(i);
    RayRef deeper = rays;
    if (!narrow(deeper, box)) continue;
    if (level > 0) {
      visit(level - 1, child, deeper);
    } else {
      meet_cluster(d_.clusters.clusters()[child], deeper, box);
    }
  }
}

// Tiles below the node that the box meets, into scratch_.hits, at least until they are more than few.
void RootDescent::collect(int level, std::uint32_t number, const FaceBox& box, int& count) {
  RayNode& n = node(level, number);
  n.tests += 1;
  std::uint32_t met = children_met(n, box);
  if (level == 0) {
    if (met != 0) scratch_.hits.push_back({number, met});
    count += std::popcount(met);
    return;
  }
  for (; met != 0 && count <= few_tiles; met &= met - 1)
    collect(level - 1, n.child[std::countr_zero(met)], box, count);
}

void RootDescent::meet_cluster(const TriangleCluster& cluster, const RayRef& rays, const FaceBox& box) {
  scratch_.hits.clear();
  int tiles = 0;
  collect(rays.level, rays.node, box, tiles);
  if (tiles == 0) return;
  FaceBoxes boxes;
  const std::uint32_t ahead = project_triangles(cluster, light_, face_, box, boxes);
  if (tiles <= few_tiles) return meet_tiles(cluster, ahead, boxes);
  set_up_planes(cluster, d_.source, skip_own_, d_.cull_front, scratch_.planes);
  meet_triangles(cluster, rays, ahead & scratch_.planes.valid, boxes);
}

// Few tiles: each looks for its triangles, whose planes are not needed before one is found.
void RootDescent::meet_tiles(const TriangleCluster& cluster, std::uint32_t ahead, const FaceBoxes& boxes) {
  bool set_up = false;
  for (const DescentScratch::Hits& hit : scratch_.hits) {
    RayNode& n = node(0, hit.node);
    for (std::uint32_t left = hit.tiles; left != 0; left &= left - 1) {
      const int slot = std::countr_zero(left);
      n.tests += 1;
      std::uint32_t near = ahead & boxes_met(boxes, n.box(slot));
      if (skip_own_) near &= ~equal_bits(cluster.ids, n.own[slot]);
      if (near == 0) continue;
      if (!set_up) {
        set_up = true;
        set_up_planes(cluster, d_.source, skip_own_, d_.cull_front, scratch_.planes);
        ahead &= scratch_.planes.valid;
        near &= ahead;
      }
      RayTile& met = tile(n, slot);
      for (; near != 0 && met.live != 0; near &= near - 1) {
        const int i = std::countr_zero(near);
        test_triangle(met, i, cluster.ids[i]);
      }
      if (met.live == 0) n.live &= ~(1u << slot);
    }
    if (n.live == 0) retire(0, hit.node);
  }
}

// Many: each triangle looks for its tiles.
void RootDescent::meet_triangles(const TriangleCluster& cluster, const RayRef& rays, std::uint32_t left,
                                 const FaceBoxes& boxes) {
  alignas(64) float u0[16], u1[16], v0[16], v1[16], w[16];
  store(boxes.u0, u0), store(boxes.u1, u1), store(boxes.v0, v0), store(boxes.v1, v1), store(boxes.w, w);
  for (; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    FaceTriangle t = face_triangle(scratch_.planes, i, face_, d_.forest.tau);
    t.box = {u0[i], u1[i], v0[i], v1[i], w[i]};
    descend_triangle(rays.level, rays.node, t, i, cluster.ids[i]);
  }
}

void RootDescent::descend_triangle(int level, std::uint32_t number, const FaceTriangle& t, int lane,
                                   std::uint32_t id) {
  RayNode& n = node(level, number);
  n.tests += 1;
  std::uint32_t met = children_met(n, t);
  if (level == 0 && met != 0) {
    if (skip_own_) met &= ~equal_bits(n.own, id);
    met = cover_tiles(n, t, met, id);
  }
  for (; met != 0; met &= met - 1) {
    const int slot = std::countr_zero(met);
    if (level > 0) {
      descend_triangle(level - 1, n.child[slot], t, lane, id);
      continue;
    }
    RayTile& below = tile(n, slot);
    test_triangle(below, lane, id);
    if (below.live == 0) n.live &= ~(1u << slot);
  }
  if (n.live == 0) retire(level, number);
}

// Early accept: tiles that the triangle covers are done with, unread. Returns those that must be tested.
std::uint32_t RootDescent::cover_tiles(RayNode& n, const FaceTriangle& t, std::uint32_t met,
                                       std::uint32_t id) {
  for (std::uint32_t left = met & children_covered(n, t); left != 0; left &= left - 1) {
    const int slot = std::countr_zero(left);
    RayTile& below = tile(n, slot);
    if (may_own(below, id)) continue;
    below.live = 0;
    n.live &= ~(1u << slot);
    met &= ~(1u << slot);
    ++stats_.early_accepts;
  }
  fetch_tiles(n, met);
  return met;
}

// A node whose rays are all blocked is met by nothing more.
void RootDescent::retire(int level, std::uint32_t number) {
  while (level + 1 < ray_levels) {
    const RayNode& n = node(level, number);
    RayNode& parent = node(level + 1, n.parent);
    parent.live &= ~(1u << n.slot);
    if (parent.live != 0) return;
    number = n.parent;
    ++level;
  }
}

// K of the float filter: with r >= |q| a sum in floats is off by at most 10.1 u r + rho (R + reach), or
// cannot have the wrong sign at all (|e0| > 2r). The last factor covers the roundings of K itself.
HWY_INLINE float constant_part(const TileRays& rays, float tau) {
  return (10.1f * u * rays.radius + 2 * u * tau) * (1 + 16 * u) + 0x1p-122f;
}

void RootDescent::test_triangle(RayTile& tile, int i, std::uint32_t id) {
  tile.tests += 1;
  const ClusterPlanes& c = scratch_.planes;
  const TileRays& rays = rays_of(tile);
  float e[4];
  for (int k = 0; k < 4; ++k) {
    const double value = c.mx[k][i] * rays.base[0] - (k == 3 ? c.d[i] : 0.0) + c.my[k][i] * rays.base[1] +
                         c.mz[k][i] * rays.base[2];
    e[k] = static_cast<float>(value);
  }
  const float k = c.rho[i] * (rays.reach + c.reach[i]) * (1 + 16 * u) + constant_part(rays, tile.tau);
  test_rays(tile, rays, i, e, k, id);
}

// Sixteen rays against one triangle. `e0`: its planes at the tile's base; the own plane opens tau of the
// rays' own triangles later.
void RootDescent::test_rays(RayTile& tile, const TileRays& rays, int i, const float e0[4], float k,
                            std::uint32_t id) {
  const ClusterPlanes& c = scratch_.planes;
  stats_.leaf_tests += static_cast<std::uint64_t>(std::popcount(tile.live));
  const Pack3<Float16> q{load<Float16>(rays.qx), load<Float16>(rays.qy), load<Float16>(rays.qz)};
  const auto value = [&](int plane) HWY_ATTR {
    const Pack3<Float16> m = splat3<Float16>(c.fx[plane][i], c.fy[plane][i], c.fz[plane][i]);
    return multiply_add(m.z, q.z, multiply_add(m.y, q.y, multiply_add(m.x, q.x, splat<Float16>(e0[plane]))));
  };
  const Float16 edges = min(value(0), min(value(1), value(2))), own = value(3);
  const std::uint32_t missed = less_bits(min(edges, own), splat<Float16>(-k));
  const std::uint32_t near = tile.live & ~missed;
  if (near == 0) return;
  std::uint32_t blocked = near & less_bits(splat<Float16>(k), min(edges, own - splat<Float16>(tile.tau)));
  const std::uint32_t open = near & ~blocked;
  if (blocked != 0 && may_own(tile, id)) blocked &= ~own_lanes(tile, blocked, id);
  tile.live &= ~blocked;
  if (open != 0) settle(tile, open, id);
}

std::size_t RootDescent::pixel_of(const RayTile& tile, int lane) const {
  return tile.pixel + static_cast<std::size_t>(lane % 4) +
         static_cast<std::size_t>(lane / 4) * static_cast<std::size_t>(d_.points.width);
}

std::uint32_t RootDescent::own_lanes(const RayTile& tile, std::uint32_t lanes, std::uint32_t id) const {
  std::uint32_t own = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    if (d_.points.triangles[pixel_of(tile, lane)] == id) own |= 1u << lane;
  }
  return own;
}

void RootDescent::settle(RayTile& tile, std::uint32_t open, std::uint32_t id) {
  if (may_own(tile, id)) open &= ~own_lanes(tile, open, id);
  if (open == 0) return;
  const bool use_tau = d_.contact == ContactRule::triangle_ids;
  const Corners corners = corners_of(d_.triangles, id);
  const TrianglePlanes planes = planes_of(corners.v, id, light_side(corners.v, d_.source), d_.source,
                                          use_tau ? rounding_tolerance(corners.v) : 0.0);
  for (; open != 0; open &= open - 1) {
    const int lane = std::countr_zero(open);
    const std::size_t pixel = pixel_of(tile, lane);
    if (decide(planes, d_.points.positions[pixel], d_.points.triangles[pixel], d_.source, d_.triangles,
               d_.contact, stats_))
      tile.live &= ~(1u << lane);
  }
}

void descend(const Descent& d, std::uint32_t root, DescentScratch& scratch, TraceStats& stats) {
  const auto& levels = d.clusters.levels();
  if (levels.empty()) return;
  RootDescent(d, root, scratch, stats)
      .visit(levels.size() - 1, 0, {ray_levels - 1, root, d.forest.root_boxes[root]});
}

}  // namespace

DescentKernels descent_kernels() {
  return {descend};
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra {

DescentKernels descent_kernels(SimdLevel level) {
  switch (level == SimdLevel::automatic ? best_simd_level() : level) {
#if HWY_TARGETS & HWY_AVX3
    case SimdLevel::avx512:
      return N_AVX3::descent_kernels();
#endif
#if HWY_TARGETS & HWY_AVX2
    case SimdLevel::avx2:
      return N_AVX2::descent_kernels();
#endif
#if HWY_TARGETS & HWY_SSE4
    case SimdLevel::sse4:
      return N_SSE4::descent_kernels();
#endif
    default:
      return HWY_STATIC_DISPATCH(descent_kernels)();
  }
}

}  // namespace tenebra
#endif
