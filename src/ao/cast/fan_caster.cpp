// Sixteen rays from one point through a tree of triangles. With the point as the origin, a ray is inside a
// triangle where it is on one side of the three planes through the point and the edges: three products, and
// two triangles that share an edge leave no gap, for their planes there differ in sign only.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ao/cast/fan_caster.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "ao/cast/fan_caster.h"
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

#include <algorithm>
#include <bit>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::ao::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

// Products and sums apart, never fused: the bits are the same on all targets.
template <class P>
SIMD_INLINE P inner(const Pack3<P>& a, const Pack3<P>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
SIMD_INLINE Float16 inverse(Float16 d) {
  const Float16 tiny = broadcast<Float16>(1e-18f);
  return broadcast<Float16>(1.0f) / copy_sign(max(abs(d), tiny), d);
}

struct Fan {
  float origin[3];
  Pack3<Float16> direction, inverted;
  Float16 distance;
  Float16 facing;
  float reach;  // the longest of the distances
};

// Squares of the distances from the origin to the boxes.
SIMD_INLINE void box_distances(const BvhNode& node, const Fan& fan, float* out) {
  const Float8 zero = broadcast<Float8>(0.0f);
  Float8 square = zero;
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 o = broadcast<Float8>(fan.origin[axis]);
    const Float8 off =
        max(zero, max(load<Float8>(node.plane[axis]) - o, o - load<Float8>(node.plane[3 + axis])));
    square = square + off * off;
  }
  store(square, out);
}

SIMD_INLINE bool meets_box(const BvhNode& node, int child, const Fan& fan) {
  Float16 first = broadcast<Float16>(0.0f), last = fan.distance;
  const Float16* inverted[3] = {&fan.inverted.x, &fan.inverted.y, &fan.inverted.z};
  for (int axis = 0; axis < 3; ++axis) {
    const Float16 a = broadcast<Float16>(node.plane[axis][child] - fan.origin[axis]) * *inverted[axis];
    const Float16 b = broadcast<Float16>(node.plane[3 + axis][child] - fan.origin[axis]) * *inverted[axis];
    first = max(first, min(a, b));
    last = min(last, max(a, b) * broadcast<Float16>(1 + 8 * 0x1p-24f));  // rounding loses at most three parts
  }
  return any(le(first, last));
}

// Planes through the origin and the edges of eight triangles.
struct EdgePlanes {
  alignas(32) float n[3][3][bvh_width];  // [edge][axis][triangle]
  alignas(32) float volume[bvh_width];   // (b - a) x (c - a) . a
  std::uint32_t near;                    // triangles whose planes are within the reach
};

SIMD_INLINE void edge_planes(const TriangleBlock& block, const Fan& fan, EdgePlanes& out) {
  Pack3<Float8> p[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = {load<Float8>(block.corner[k][0]) - broadcast<Float8>(fan.origin[0]),
            load<Float8>(block.corner[k][1]) - broadcast<Float8>(fan.origin[1]),
            load<Float8>(block.corner[k][2]) - broadcast<Float8>(fan.origin[2])};
  }
  const Pack3<Float8> n[3] = {cross(p[1], p[2]), cross(p[2], p[0]), cross(p[0], p[1])};
  for (int k = 0; k < 3; ++k)
    store(n[k].x, out.n[k][0]), store(n[k].y, out.n[k][1]), store(n[k].z, out.n[k][2]);
  const Pack3<Float8> normal = cross(Pack3<Float8>{p[1].x - p[0].x, p[1].y - p[0].y, p[1].z - p[0].z},
                                     Pack3<Float8>{p[2].x - p[0].x, p[2].y - p[0].y, p[2].z - p[0].z});
  const Float8 volume = inner(normal, p[0]);
  store(volume, out.volume);
  const Float8 farthest = broadcast<Float8>(fan.reach * (1 + 0x1p-10f));
  out.near = bits(le(volume * volume, farthest * farthest * inner(normal, normal)));
}

SIMD_INLINE void meet_block(const TriangleBlock& block, Fan& fan) {
  EdgePlanes planes;
  edge_planes(block, fan, planes);
  const Float16 zero = broadcast<Float16>(0.0f);
  for (std::uint32_t left = planes.near; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    const auto side = [&](int edge) {
      return (fan.direction.x * broadcast<Float16>(planes.n[edge][0][i]) +
              fan.direction.y * broadcast<Float16>(planes.n[edge][1][i])) +
             fan.direction.z * broadcast<Float16>(planes.n[edge][2][i]);
    };
    const Float16 u = side(0), v = side(1), w = side(2);
    const auto inside = le(zero, min(u, min(v, w))) | le(max(u, max(v, w)), zero);
    if (!any(inside)) continue;
    const Float16 sum = (u + v) + w, t = broadcast<Float16>(planes.volume[i]) / sum;
    const auto hit = inside & lt(zero, t) & lt(t, fan.distance);
    fan.distance = select(hit, t, fan.distance);
    fan.facing = select(hit, zero - sum, fan.facing);
  }
}

// Square of the reach with room for rounding; finite, so that the boxes of empty places (infinitely far) stay
// out.
SIMD_INLINE float limit(const Fan& fan) {
  return std::min(fan.reach * fan.reach * (1 + 0x1p-18f), std::numeric_limits<float>::max());
}

struct Entry {
  float square;
  std::uint32_t child;
};

void closest_fan(const TriangleBvh& bvh, const RayBatch& rays, float* distance, float* facing) {
  if (bvh.nodes.empty()) return;
  const glm::vec3 origin = rays.origin(0);
  const Pack3<Float16> d{load<Float16>(rays.dx), load<Float16>(rays.dy), load<Float16>(rays.dz)};
  Fan fan{
      {origin.x, origin.y, origin.z}, d, {inverse(d.x), inverse(d.y), inverse(d.z)}, load<Float16>(distance),
      broadcast<Float16>(0.0f),       0};
  fan.reach = reduce_max(fan.distance);
  Entry stack[bvh_depth * (bvh_width - 1) + 1];
  int size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.square <= limit(fan))) continue;
    if (entry.child & bvh_leaf) {
      meet_block(bvh.blocks[entry.child & ~bvh_leaf], fan);
      fan.reach = reduce_max(fan.distance);
      continue;
    }
    const BvhNode& node = bvh.nodes[entry.child];
    float squares[bvh_width];
    box_distances(node, fan, squares);
    const int base = size;
    for (int i = 0; i < bvh_width; ++i) {
      if (!(squares[i] <= limit(fan)) || !meets_box(node, i, fan)) continue;
      int place = size++;
      for (; place > base && stack[place - 1].square < squares[i]; --place) stack[place] = stack[place - 1];
      stack[place] = {squares[i], node.child[i]};
    }
  }
  store(fan.distance, distance);
  if (facing != nullptr) store(fan.facing, facing);
}

}  // namespace

ClosestFan closest_fan_kernel() {
  return closest_fan;
}

}  // namespace tenebra::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::ao {

ClosestFan closest_fan(SimdLevel level) {
  return TENEBRA_DISPATCH(level, closest_fan_kernel)();
}

}  // namespace tenebra::ao
#endif
