// One ray through the tree: eight boxes or eight triangles at once. Without fused operations, so that every
// instruction set gives the same bits.
#if defined(TENEBRA_TREES_BVH_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_TREES_BVH_TRACE_INL_H_
#undef TENEBRA_TREES_BVH_TRACE_INL_H_
#else
#define TENEBRA_TREES_BVH_TRACE_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "simd/pack-inl.h"
#include "trees/triangle_bvh.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::trees::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

constexpr float no_distance = std::numeric_limits<float>::infinity();
constexpr float largest_distance = std::numeric_limits<float>::max();

// What boxes are tested with. 1 / direction is kept finite so that no product is NaN.
struct Slabs {
  float origin[3], inverse[3];
  int near[3], far[3];  // which plane of a box comes first along each axis: rows of BvhNode::plane
  float from, to;
};

inline Slabs slabs_of(const CasterRay& ray) {
  Slabs slabs;
  slabs.from = ray.from, slabs.to = ray.to;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = ray.direction[axis];
    slabs.origin[axis] = ray.origin[axis];
    slabs.inverse[axis] = 1 / (std::abs(d) < 1e-18f ? std::copysign(1e-18f, d) : d);
    slabs.near[axis] = axis + (slabs.inverse[axis] < 0 ? 3 : 0);
    slabs.far[axis] = axis + (slabs.inverse[axis] < 0 ? 0 : 3);
  }
  return slabs;
}

// Bits of the children that the ray may meet, and where it enters them. Rounding loses at most three parts
// in 2^24 of each end: the last end is moved out by more.
SIMD_INLINE std::uint32_t meet_boxes(const BvhNode& node, const Slabs& ray, float* enter) {
  Float8 first = broadcast<Float8>(ray.from), last = broadcast<Float8>(ray.to);
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 origin = broadcast<Float8>(ray.origin[axis]), inverse = broadcast<Float8>(ray.inverse[axis]);
    first = max(first, (load<Float8>(node.plane[ray.near[axis]]) - origin) * inverse);
    last = min(last, (load<Float8>(node.plane[ray.far[axis]]) - origin) * inverse *
                         broadcast<Float8>(1 + 8 * 0x1p-24f));
  }
  store(first, enter);
  return bits(le(first, last));
}

// The frame in which the ray runs along its longest axis and everything is sheared onto the plane across
// (Woop, Benthin and Wald 2013).
struct Shear {
  int x, y, z;  // axes, z the longest
  float to_x, to_y, to_z;
};

inline Shear shear_along(glm::vec3 d) {
  const glm::vec3 size = glm::abs(d);
  const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  return {x, y, z, d[x] / d[z], d[y] / d[z], 1 / d[z]};
}

// Distances to the eight triangles, no_distance where there is no hit. In the plane, an edge's side is the
// sign of a difference of two products: rounding may make it zero, never turn it over. Zero counts as inside,
// so that neighbours leave no gap, not even at vertices.
SIMD_INLINE Float8 meet_triangles(const BvhTriangles& block, const CasterRay& ray, const Shear& shear) {
  const Float8 to_x = broadcast<Float8>(shear.to_x), to_y = broadcast<Float8>(shear.to_y);
  Pack3<Float8> p[3];
  for (int k = 0; k < 3; ++k) {
    const Float8 z = load<Float8>(block.corner[k][shear.z]) - broadcast<Float8>(ray.origin[shear.z]);
    p[k] = {load<Float8>(block.corner[k][shear.x]) - broadcast<Float8>(ray.origin[shear.x]) - to_x * z,
            load<Float8>(block.corner[k][shear.y]) - broadcast<Float8>(ray.origin[shear.y]) - to_y * z, z};
  }
  const Float8 u = p[2].x * p[1].y - p[2].y * p[1].x, v = p[0].x * p[2].y - p[0].y * p[2].x,
               w = p[1].x * p[0].y - p[1].y * p[0].x;
  const Float8 zero = broadcast<Float8>(0.0f), none = broadcast<Float8>(no_distance);
  const Float8 scale = broadcast<Float8>(1.0f) / ((u + v) + w);  // inverted first: products stay in range
  const Float8 t =
      ((u * scale * p[0].z + v * scale * p[1].z) + w * scale * p[2].z) * broadcast<Float8>(shear.to_z);
  const auto inside = le(zero, min(u, min(v, w))) | le(max(u, max(v, w)), zero);
  const auto ahead = lt(broadcast<Float8>(ray.from), t) & lt(t, broadcast<Float8>(ray.to));
  return select(inside & ahead, t, none);
}

inline bool usable(const CasterRay& ray) {
  const float sum = std::abs(ray.origin.x) + std::abs(ray.origin.y) + std::abs(ray.origin.z);
  const float size = std::abs(ray.direction.x) + std::abs(ray.direction.y) + std::abs(ray.direction.z);
  return sum < 1e18f && size < 1e18f && size > 0 && ray.from < ray.to;
}

struct Entry {
  float enter;
  std::uint32_t child;
};

// At each level one child is on its way and the others wait.
constexpr int stack_size = bvh_depth * (bvh_width - 1) + 1;

template <bool Any>
CasterHit trace_ray(const TriangleBvh& bvh, CasterRay ray) {
  CasterHit hit;
  if (bvh.nodes.empty() || !usable(ray)) return hit;
  Slabs slabs = slabs_of(ray);
  const Shear shear = shear_along(ray.direction);
  Entry stack[stack_size];
  int size = 0;
  stack[size++] = {ray.from, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.enter > slabs.to) continue;
    if (entry.child & bvh_leaf) {
      const BvhTriangles& block = bvh.blocks[entry.child & ~bvh_leaf];
      const Float8 t = meet_triangles(block, ray, shear);
      std::uint32_t met = bits(le(t, broadcast<Float8>(std::min(hit.distance, largest_distance))));
      if (met == 0) continue;
      float distance[bvh_width];
      store(t, distance);
      for (; met != 0; met &= met - 1) {
        const CasterHit found{distance[std::countr_zero(met)], block.triangle[std::countr_zero(met)]};
        if (found.triangle == ray.skip || found.distance > hit.distance) continue;
        if (found.distance == hit.distance && found.triangle > hit.triangle) continue;
        hit = found;
        if (Any) return hit;
      }
      slabs.to = std::min(slabs.to, hit.distance);
      continue;
    }
    const BvhNode& node = bvh.nodes[entry.child];
    float enter[bvh_width];
    const int base = size;
    for (std::uint32_t met = meet_boxes(node, slabs, enter); met != 0; met &= met - 1) {
      const int lane = std::countr_zero(met);
      int place = size++;
      for (; place > base && stack[place - 1].enter < enter[lane]; --place) stack[place] = stack[place - 1];
      stack[place] = {enter[lane], node.child[lane]};
    }
  }
  return hit;
}

}  // namespace tenebra::trees::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
