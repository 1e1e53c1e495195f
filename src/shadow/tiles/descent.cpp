// The two trees descended together, compiled once per instruction set.
#include "shadow/tiles/descent.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/tiles/descent.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "shadow/decision/decide.h"
#include "shadow/tiles/descent_sides-inl.h"
#include "shadow/tiles/double_test-inl.h"
#include "shadow/tiles/live_rays-inl.h"
#include "shadow/tiles/ray_test-inl.h"
#include "simd/dispatch.h"
#include "simd/pack-inl.h"
#include "simd/prefetch.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

/// How wide a box is as seen from the light.
SIMD_INLINE float width(const FaceBox& box) {
  return (box.u1 - box.u0) + (box.v1 - box.v0);
}

/// A slot of a node of tiles, and triangles of the cluster that it is to be tested with.
struct Waiting {
  std::uint32_t node;
  std::uint16_t slot, triangles;
};
constexpr int most_waiting = 32;
constexpr float much_wider = 6;  // times the width of the triangles' box, as seen from the light

template <class Side>
class RootDescent {
public:
  RootDescent(const Descent& d, const Side& side, DescentScratch& scratch, TraceStats& stats)
      : d_(d),
        side_(side),
        live_(d, side_),
        skip_own_(d.contact == ContactRule::triangle_ids),
        pixels_(d.points.width, d.points.height),
        finder_(d.points, d.triangles),
        scratch_(scratch),
        stats_(stats) {}

  void visit(std::size_t level, std::size_t number, const RayRef& rays);

private:
  RayNode& node(const RayRef& ref) { return live_.node(ref.level, ref.node); }
  RayNode& node(int level, std::uint32_t number) { return live_.node(level, number); }
  const points::PointTile& tile(const RayNode& n, int slot) const { return live_.tile(n, slot); }
  const points::PointBase& base(const RayNode& n, int slot) const { return live_.base(n, slot); }

  void note_test(RayNode& n) {
    ++n.tests;
    ++stats_.nodes;
  }
  void enter(std::size_t level, std::size_t number, const FaceBox& box, const RayRef& rays,
             std::uint32_t met);
  void fetch_nodes(const RayNode& n, int level, std::uint32_t slots) const;
  std::uint32_t narrow(RayRef& rays, const FaceBox& box);
  void meet_cluster(const TriangleCluster& cluster, const RayRef& rays, const FaceBox& box);
  void descend_cluster(const RayRef& rays, std::uint32_t mask);
  void set_up_cluster();
  FaceBox box_of(int i) const {
    return {lanes_[0][i], lanes_[1][i], lanes_[2][i], lanes_[3][i], lanes_[4][i]};
  }
  void meet_tiles(const RayRef& rays, std::uint32_t met, std::uint32_t mask);
  void by_tiles(std::uint32_t number, std::uint32_t met, std::uint32_t mask);
  void by_triangles(std::uint32_t number, std::uint32_t mask);
  void put_off(std::uint32_t number, int slot, std::uint32_t triangles);
  void test_waiting();
  std::uint32_t cover_tiles(RayNode& n, int i, std::uint32_t met);
  void test_tile(const Waiting& w);
  bool test_triangle(const Waiting& w, const RoughRays& rough, int i);
  /// The lanes whose points lie on triangle `id`, which never blocks those, in a slot with points on several
  /// triangles. Where all points lie on one, by_tiles() and by_triangles() have left that one out.
  std::uint32_t own_lanes(const RayNode& n, int slot, std::uint32_t id) const {
    return n.own[slot] == no_triangle && skip_own_ ? eq_bits(tile(n, slot).id, id) : 0;
  }
  std::uint32_t blocked_lanes(const RayNode& n, int slot, std::uint32_t open, int i);

  const Descent& d_;
  const Side side_;
  LiveRays<Side> live_;
  const bool skip_own_;  ///< whether a triangle never blocks its own points
  const points::TilePixels pixels_;
  points::PositionFinder finder_;
  DescentScratch& scratch_;
  TraceStats& stats_;
  // The cluster that descends:
  const TriangleCluster* cluster_ = nullptr;
  FaceBox cluster_box_{};
  FaceBoxes boxes_;                 ///< of its triangles
  alignas(64) float lanes_[5][16];  ///< the same, for box_of
  bool set_up_ = false;             ///< whether the scratch's planes, and on_face_, are this cluster's
  FaceCluster on_face_;
  Waiting waiting_[most_waiting];
  int waiting_count_ = 0;
};

// Prefetches nodes that are about to be met.
template <class Side>
void RootDescent<Side>::fetch_nodes(const RayNode& n, int level, std::uint32_t slots) const {
  if ((slots & (slots - 1)) == 0) return;
  const std::vector<RayNode>& below = d_.forest.levels[static_cast<std::size_t>(level) - 1];
  for (; slots != 0; slots &= slots - 1) simd::prefetch_all(below[n.child[std::countr_zero(slots)]]);
}

// Moves `rays` down to the deepest node that holds all rays which the box may meet; returns the bits of its
// children that may have such rays; 0: there are none.
template <class Side>
std::uint32_t RootDescent<Side>::narrow(RayRef& rays, const FaceBox& box) {
  for (;;) {
    RayNode& n = node(rays);
    note_test(n);
    const std::uint32_t met = children_met(n, box);
    if (rays.level == 0 || (met & (met - 1)) != 0 || met == 0) return met;
    const int slot = std::countr_zero(met);
    rays = {rays.level - 1, n.child[slot], n.box(slot)};
  }
}

template <class Side>
void RootDescent<Side>::visit(std::size_t level, std::size_t number, const RayRef& rays) {
  RayNode& n = node(rays);
  if (n.live == 0 || stop_requested(d_.stop)) return;
  note_test(n);
  FaceBoxes boxes;
  std::uint32_t met = side_.project(d_.clusters.levels()[level][number], boxes);
  met &= boxes_met(boxes, rays.box);
  if (met == 0) return;
  alignas(64) float u0[16], u1[16], v0[16], v1[16], w[16];
  store(boxes.u0, u0), store(boxes.u1, u1), store(boxes.v0, v0), store(boxes.v1, v1), store(boxes.w, w);
  const auto child_of = [&](int i) { return number * cluster_size + static_cast<std::size_t>(i); };
  const auto box_of_child = [&](int i) { return FaceBox{u0[i], u1[i], v0[i], v1[i], w[i]}; };
  RayRef deeper[16];
  std::uint32_t children[16], entered = 0;
  for (; met != 0; met &= met - 1) {
    const int i = std::countr_zero(met);
    deeper[i] = rays;
    children[i] = narrow(deeper[i], box_of_child(i));
    if (children[i] == 0) continue;
    entered |= 1u << i;
    level > 0 ? simd::prefetch_all(d_.clusters.levels()[level - 1][child_of(i)])
              : simd::prefetch_all(d_.clusters.clusters()[child_of(i)]);
  }
  for (; entered != 0; entered &= entered - 1) {
    const int i = std::countr_zero(entered);
    if (level > 0) {
      enter(level - 1, child_of(i), box_of_child(i), deeper[i], children[i]);
    } else {
      meet_cluster(d_.clusters.clusters()[child_of(i)], deeper[i], box_of_child(i));
    }
  }
}

// A node of clusters within `box`, and a node of rays whose children `met` the box meets. Where the rays lie
// much wider than the triangles, the rays are descended first: nearly all of them are far from the triangles,
// and few are left further down. Else the triangles are: what is worked out for them serves all rays.
template <class Side>
void RootDescent<Side>::enter(std::size_t level, std::size_t number, const FaceBox& box, const RayRef& rays,
                              std::uint32_t met) {
  if (rays.level == 0 || width(rays.box) <= much_wider * width(box)) return visit(level, number, rays);
  const RayNode& n = node(rays);
  fetch_nodes(n, rays.level, met);
  for (; met != 0; met &= met - 1) {
    const int slot = std::countr_zero(met);
    RayRef below{rays.level - 1, n.child[slot], n.box(slot)};
    const std::uint32_t met_below = narrow(below, box);
    if (met_below != 0) enter(level, number, box, below, met_below);
  }
}

template <class Side>
void RootDescent<Side>::meet_cluster(const TriangleCluster& cluster, const RayRef& rays, const FaceBox& box) {
  const std::uint32_t ahead = side_.project(cluster, box, boxes_) & boxes_met(boxes_, rays.box);
  if (ahead == 0) return;
  cluster_ = &cluster;
  cluster_box_ = box;
  set_up_ = false;
  descend_cluster(rays, ahead);
  test_waiting();
}

// The triangles of `mask` meet the box of `rays`. All children that are entered are prefetched before the
// first is.
template <class Side>
void RootDescent<Side>::descend_cluster(const RayRef& rays, std::uint32_t mask) {
  RayNode& n = node(rays);
  note_test(n);
  const std::uint32_t met = children_met(n, cluster_box_);
  if (met == 0) return live_.tighten(rays);
  if (rays.level == 0) return meet_tiles(rays, met, mask);
  std::uint16_t deeper[16];
  std::uint32_t entered = 0;
  for (std::uint32_t left = met; left != 0; left &= left - 1) {
    const int slot = std::countr_zero(left);
    note_test(n);
    deeper[slot] = static_cast<std::uint16_t>(mask & boxes_met(boxes_, n.box(slot)));
    if (deeper[slot] != 0) entered |= 1u << slot;
  }
  fetch_nodes(n, rays.level, entered);
  for (; entered != 0; entered &= entered - 1) {
    const int slot = std::countr_zero(entered);
    descend_cluster({rays.level - 1, n.child[slot], n.box(slot)}, deeper[slot]);
  }
}

// Called when the box of a triangle first meets a node of tiles: before, no planes are needed.
template <class Side>
void RootDescent<Side>::set_up_cluster() {
  set_up_ = true;
  store(boxes_.u0, lanes_[0]), store(boxes_.u1, lanes_[1]), store(boxes_.v0, lanes_[2]);
  store(boxes_.v1, lanes_[3]), store(boxes_.w, lanes_[4]);
  set_up_planes(*cluster_, d_.source, skip_own_, d_.cull_front, scratch_.planes);
  side_.place(scratch_.planes, d_.forest.tau, on_face_);
  for (std::uint32_t left = scratch_.planes.edge_on; left != 0; left &= left - 1)
    scratch_.edge_on.push_back(cluster_->ids[std::countr_zero(left)]);
}

// If there are no more tiles than triangles, each tile is tested with all triangles at once; else each
// triangle with all tiles.
template <class Side>
void RootDescent<Side>::meet_tiles(const RayRef& rays, std::uint32_t met, std::uint32_t mask) {
  if (!set_up_) set_up_cluster();
  mask &= scratch_.planes.valid & triangles_met(on_face_, rays.box);
  if (mask == 0) return;
  if (std::popcount(met) <= std::popcount(mask)) {
    by_tiles(rays.node, met, mask);
  } else {
    by_triangles(rays.node, mask);
  }
}

template <class Side>
void RootDescent<Side>::by_tiles(std::uint32_t number, std::uint32_t met, std::uint32_t mask) {
  RayNode& n = node(0, number);
  for (; met != 0; met &= met - 1) {
    const int slot = std::countr_zero(met);
    note_test(n);
    const FaceBox box = n.box(slot);
    std::uint32_t found = mask & boxes_met(boxes_, box);
    if (skip_own_) found &= ~eq_bits(cluster_->ids, n.own[slot]);
    if (found != 0) found &= triangles_met(on_face_, box);
    if (found != 0) put_off(number, slot, found);
  }
}

template <class Side>
void RootDescent<Side>::by_triangles(std::uint32_t number, std::uint32_t mask) {
  RayNode& n = node(0, number);
  std::uint16_t found[16] = {};
  std::uint32_t tested = 0;
  for (; mask != 0 && n.live != 0; mask &= mask - 1) {
    const int i = std::countr_zero(mask);
    note_test(n);
    std::uint32_t met = children_met(n, on_face_, i, box_of(i));
    if (skip_own_) met &= ~eq_bits(n.own, cluster_->ids[i]);
    if (met != 0) met = cover_tiles(n, i, met);
    tested |= met;
    for (; met != 0; met &= met - 1) found[std::countr_zero(met)] |= static_cast<std::uint16_t>(1u << i);
  }
  for (tested &= n.live; tested != 0; tested &= tested - 1) {
    const int slot = std::countr_zero(tested);
    put_off(number, slot, found[slot]);
  }
  if (n.live == 0) live_.retire(0, number);
}

// Prefetches a tile and leaves its test for later, when the data has had time to arrive.
template <class Side>
void RootDescent<Side>::put_off(std::uint32_t number, int slot, std::uint32_t triangles) {
  simd::prefetch_all(tile(node(0, number), slot));
  waiting_[waiting_count_++] = {number, static_cast<std::uint16_t>(slot),
                                static_cast<std::uint16_t>(triangles)};
  if (waiting_count_ == most_waiting) test_waiting();
}

template <class Side>
void RootDescent<Side>::test_waiting() {
  for (int k = 0; k < waiting_count_ && !stop_requested(d_.stop); ++k) test_tile(waiting_[k]);
  waiting_count_ = 0;
}

// Early accept: tiles that the triangle covers are done with, unread. Returns those that must be tested.
template <class Side>
std::uint32_t RootDescent<Side>::cover_tiles(RayNode& n, int i, std::uint32_t met) {
  for (std::uint32_t left = met & children_covered(n, on_face_, i); left != 0; left &= left - 1) {
    const int slot = std::countr_zero(left);
    if ((n.rays[slot] & own_lanes(n, slot, cluster_->ids[i])) != 0) continue;
    live_.drop(n, slot);
    met &= ~(1u << slot);
    ++stats_.early_accepts;
  }
  return met;
}

template <class Side>
void RootDescent<Side>::test_tile(const Waiting& w) {
  RayNode& n = node(0, w.node);
  const RoughRays rough = rough_rays(tile(n, w.slot), base(n, w.slot), d_.source.origin);
  bool missed = false;
  for (std::uint32_t left = w.triangles; left != 0 && n.rays[w.slot] != 0; left &= left - 1)
    missed |= !test_triangle(w, rough, std::countr_zero(left));
  if (n.live == 0) return live_.retire(0, w.node);
  if (missed && ((n.wide >> w.slot) & 1u) != 0 && n.rays[w.slot] != 0) live_.shrink(n, w.slot);
}

// The rays of a tile against triangle i; false: all are missed.
template <class Side>
bool RootDescent<Side>::test_triangle(const Waiting& w, const RoughRays& rough, int i) {
  RayNode& n = node(0, w.node);
  const std::uint32_t id = cluster_->ids[i], rays = n.rays[w.slot] & ~own_lanes(n, w.slot, id);
  if (d_.tile_tests != nullptr) ++(*d_.tile_tests)[w.node][w.slot];
  ++stats_.nodes;
  stats_.leaf_tests += static_cast<std::uint64_t>(std::popcount(rays));
  TileVerdict verdict = rough_verdict<Side::anchored>(scratch_.planes, i, rough, n.tau);
  if ((rays & verdict.near & ~verdict.sure) != 0)
    verdict = fine_verdict(scratch_.planes, i, tile(n, w.slot), base(n, w.slot), d_.source.origin, n.tau);
  const std::uint32_t near = rays & verdict.near, open = near & ~verdict.sure;
  if (near == 0) return false;
  std::uint32_t blocked = near & verdict.sure;
  if (open != 0) blocked |= blocked_lanes(n, w.slot, open, i);
  n.rays[w.slot] = static_cast<std::uint16_t>(n.rays[w.slot] & ~blocked);
  n.wide |= 1u << w.slot;
  if (n.rays[w.slot] == 0) live_.drop(n, w.slot);
  return true;
}

/// Those of the lanes `open` that triangle i blocks: in double, then exactly.
template <class Side>
std::uint32_t RootDescent<Side>::blocked_lanes(const RayNode& n, int slot, std::uint32_t open, int i) {
  const std::uint32_t id = cluster_->ids[i], number = n.child[slot];
  const points::Corners corners = points::corners_of(d_.triangles, id);
  const int side = ((scratch_.planes.turned >> i) & 1u) != 0 ? -1 : 1;
  const TilePositions& at = scratch_.positions.of(finder_, pixels_, number, open);
  const TileVerdict verdict =
      double_verdict(product_triangle(corners, side, d_.source, d_.contact, n.tau), at);
  stats_.float_unknown += static_cast<std::uint64_t>(std::popcount(open));
  std::uint32_t blocked = open & verdict.near & verdict.sure;
  for (open &= verdict.near & ~verdict.sure; open != 0; open &= open - 1) {
    const int lane = std::countr_zero(open);
    ++stats_.double_unknown;
    const std::uint32_t own = d_.points.triangles[pixels_(number, lane)];
    if (blocks_exactly({corners, side, all_planes}, at.at(lane), own, d_.source, d_.triangles, d_.contact))
      blocked |= 1u << lane;
  }
  return blocked;
}

void descend(const Descent& d, std::uint32_t root, DescentScratch& scratch, TraceStats& stats) {
  const auto& levels = d.clusters.levels();
  if (levels.empty()) return;
  const RayRef rays{ray_levels - 1, root, d.forest.root_boxes[root]};
  if (d.forest.distant)
    return RootDescent(d, DistantSide(*d.forest.distant), scratch, stats).visit(levels.size() - 1, 0, rays);
  RootDescent(d, CubeSide(d.source, d.forest.faces[root]), scratch, stats).visit(levels.size() - 1, 0, rays);
}

ClusterVerdict meet(const TriangleCluster& cluster, const BoxNode& boxes, const RaySource& source, int face,
                    const DistantFace* distant, const FaceBox& rays, float tau) {
  return distant != nullptr ? meet_on(DistantSide(*distant), cluster, boxes, source, rays, tau)
                            : meet_on(CubeSide(source, face), cluster, boxes, source, rays, tau);
}

}  // namespace

DescentKernels descent_kernels() {
  return {descend, meet};
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::shadow {

DescentKernels descent_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, descent_kernels)();
}

}  // namespace tenebra::shadow
#endif
