// The forest of rays while triangles descend through it: which rays are not yet blocked, and boxes that
// shrink to the remaining rays. Included once per target.
#if defined(TENEBRA_LIVE_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_LIVE_RAYS_INL_H_
#undef TENEBRA_LIVE_RAYS_INL_H_
#else
#define TENEBRA_LIVE_RAYS_INL_H_
#endif

#include "shadow/tiles/descent.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {

/// A node of rays and its own bounds.
struct RayRef {
  int level;
  std::uint32_t node;
  FaceBox box;
};

template <class Side>
class LiveRays {
public:
  LiveRays(const Descent& d, const Side& side) : forest_(d.forest), tiles_(d.tiles), side_(side) {}

  RayNode& node(int level, std::uint32_t number) const {
    return forest_.levels[static_cast<std::size_t>(level)][number];
  }
  const points::PointTile& tile(const RayNode& n, int slot) const { return tiles_.tiles[n.child[slot]]; }
  const points::PointBase& base(const RayNode& n, int slot) const { return tiles_.bases[n.child[slot] / 16]; }

  /// Takes a tile, whose rays are all blocked, out of its node.
  void drop(RayNode& n, int slot) const {
    n.rays[slot] = 0;
    n.live &= ~(1u << slot);
    node(1, n.parent).wide |= 1u << n.slot;
  }
  /// Shrinks the box of a tile to its remaining rays. Called when a triangle has met the box but no ray: the
  /// box may have been made for all points, or for rays that are blocked by now.
  void shrink(RayNode& n, int slot) const;
  /// Shrinks the box of a node to its remaining rays. Called when a cluster has met the box but none of the
  /// children: the box may be that of rays which are blocked by now.
  void tighten(const RayRef& rays) const;
  /// Takes a node whose rays are all blocked out of its parent, and parents left empty with it.
  void retire(int level, std::uint32_t number) const;

private:
  RayForest& forest_;
  const points::PointTiles& tiles_;
  const Side& side_;
};

template <class Side>
void LiveRays<Side>::shrink(RayNode& n, int slot) const {
  FaceBox box{};
  if (side_.bound_rays(tile(n, slot), base(n, slot), n.rays[slot], box)) n.set_box(slot, box);
  n.wide &= ~(1u << slot);
  node(1, n.parent).wide |= 1u << n.slot;
}

template <class Side>
void LiveRays<Side>::tighten(const RayRef& rays) const {
  if (rays.level + 1 == ray_levels) return;
  RayNode& n = node(rays.level, rays.node);
  RayNode& parent = node(rays.level + 1, n.parent);
  if (((parent.wide >> n.slot) & 1u) == 0 || n.live == 0) return;
  parent.wide &= ~(1u << n.slot);
  parent.set_box(static_cast<int>(n.slot), bounds_of(n));
  if (rays.level + 2 < ray_levels) node(rays.level + 2, parent.parent).wide |= 1u << parent.slot;
}

template <class Side>
void LiveRays<Side>::retire(int level, std::uint32_t number) const {
  while (level + 1 < ray_levels) {
    const RayNode& n = node(level, number);
    RayNode& parent = node(level + 1, n.parent);
    parent.live &= ~(1u << n.slot);
    if (parent.live != 0) return;
    number = n.parent;
    ++level;
  }
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
