// Rays from one point through a tree of triangles, four fans of sixteen at a time. With the point as the
// origin, a ray is inside a triangle where it is on one side of the three planes through the point and the
// edges: three dot products, and two triangles that share an edge leave no gap, for their planes there differ
// in sign only.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/fan_caster.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack-inl.h"
#include "trees/fan_caster.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::trees::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

// Products and sums apart, never fused: the bits are the same on all targets.
template <class P>
SIMD_INLINE P dot_unfused(const Pack3<P>& a, const Pack3<P>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
SIMD_INLINE Float16 inverse(Float16 d) {
  const Float16 tiny = broadcast<Float16>(1e-18f);
  return broadcast<Float16>(1.0f) / copy_sign(max(abs(d), tiny), d);
}

constexpr int most_rays = static_cast<int>(fans_at_once) * batch_size;
using RayBits = std::uint64_t;  // one bit for each ray
static_assert(most_rays <= 64);

inline RayBits bits_of_fan(std::uint32_t lanes, int fan) {
  return RayBits{lanes} << (fan * batch_size);
}
inline std::uint32_t lanes_of_fan(RayBits rays, int fan) {
  return static_cast<std::uint32_t>(rays >> (fan * batch_size)) & ((1u << batch_size) - 1);
}

// Rays of one point on their way.
struct Fans {
  int count = 0;
  float origin[3];
  float longest;  // length of a direction, at most
  float reach;    // how far from the origin a hit may lie
  RayBits rays;   // those with a direction
  alignas(64) float direction[3][most_rays], inverted[3][most_rays];
  alignas(64) float distance[most_rays], facing[most_rays];
};

inline void find_reach(Fans& fans) {
  Float16 most = load<Float16>(fans.distance);
  for (int f = 1; f < fans.count; ++f) most = max(most, load<Float16>(fans.distance + f * batch_size));
  fans.reach = reduce_max(most) * fans.longest;
}

inline void start(std::span<const RayBatch> rays, const float* distance, Fans& fans) {
  const glm::vec3 origin = rays[0].origin(0);
  for (int axis = 0; axis < 3; ++axis) fans.origin[axis] = origin[axis];
  fans.count = static_cast<int>(rays.size());
  fans.rays = 0;
  const Float16 zero = broadcast<Float16>(0.0f);
  Float16 longest = zero;
  for (int f = 0; f < fans.count; ++f) {
    const RayBatch& batch = rays[static_cast<std::size_t>(f)];
    const Pack3<Float16> d{load<Float16>(batch.dx), load<Float16>(batch.dy), load<Float16>(batch.dz)};
    const int at = f * batch_size;
    store(d.x, fans.direction[0] + at), store(d.y, fans.direction[1] + at);
    store(d.z, fans.direction[2] + at);
    store(inverse(d.x), fans.inverted[0] + at), store(inverse(d.y), fans.inverted[1] + at);
    store(inverse(d.z), fans.inverted[2] + at);
    store(load<Float16>(distance + at), fans.distance + at);
    store(zero, fans.facing + at);
    const Float16 square = dot_unfused(d, d);
    longest = max(longest, square);
    fans.rays |= bits_of_fan(bits(lt(zero, square)), f);
  }
  fans.longest = std::sqrt(reduce_max(longest)) * (1 + 0x1p-20f);
  find_reach(fans);
}

// A node's boxes as the origin sees them.
struct Boxes {
  alignas(32) float off[6][bvh_width];  // planes less the origin
  alignas(32) float square[bvh_width];  // of the distance
};

SIMD_INLINE void look_at_boxes(const BvhNode& node, const Fans& fans, Boxes& out) {
  const Float8 zero = broadcast<Float8>(0.0f);
  // Planes through the edges are off by 2^-22 d^2 / length of the edge, d the distance, which is at most the
  // reach: for edges of at least reach / 1024 no ray that is inside a triangle by its planes misses a box so
  // widened. A ray that is inside a smaller triangle only by such an error may miss its box.
  const Float8 margin = broadcast<Float8>(fans.reach * 0x1p-12f);
  Float8 square = zero;
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 o = broadcast<Float8>(fans.origin[axis]);
    const Float8 low = load<Float8>(node.plane[axis]) - o, high = load<Float8>(node.plane[3 + axis]) - o;
    store(low - margin, out.off[axis]), store(high + margin, out.off[3 + axis]);
    const Float8 away = max(zero, max(low, zero - high));
    square = square + away * away;
  }
  store(square, out.square);
}

// Rays of a fan that may meet a child.
SIMD_INLINE std::uint32_t meet_box(const Boxes& boxes, int child, const Fans& fans, int fan) {
  const int at = fan * batch_size;
  Float16 first = broadcast<Float16>(0.0f), last = load<Float16>(fans.distance + at);
  for (int axis = 0; axis < 3; ++axis) {
    const Float16 inverted = load<Float16>(fans.inverted[axis] + at);
    const Float16 a = broadcast<Float16>(boxes.off[axis][child]) * inverted;
    const Float16 b = broadcast<Float16>(boxes.off[3 + axis][child]) * inverted;
    first = max(first, min(a, b));
    last = min(last, max(a, b) * broadcast<Float16>(1 + 8 * 0x1p-24f));  // rounding loses at most three parts
  }
  return bits(le(first, last));
}

// Children that a ray may meet.
SIMD_INLINE std::uint32_t meet_boxes(const Boxes& boxes, const Fans& fans, int ray) {
  Float8 first = broadcast<Float8>(0.0f), last = broadcast<Float8>(fans.distance[ray]);
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 inverted = broadcast<Float8>(fans.inverted[axis][ray]);
    const Float8 a = load<Float8>(boxes.off[axis]) * inverted,
                 b = load<Float8>(boxes.off[3 + axis]) * inverted;
    first = max(first, min(a, b));
    last = min(last, max(a, b) * broadcast<Float8>(1 + 8 * 0x1p-24f));
  }
  return bits(le(first, last));
}

// Of `rays` those that may meet each of the children `near`: sixteen rays against a box or a ray against
// eight boxes, whichever takes fewer tests.
SIMD_INLINE void meet_children(const Boxes& boxes, const Fans& fans, RayBits rays, std::uint32_t near,
                               RayBits* met) {
  std::fill_n(met, bvh_width, RayBits{0});
  for (int f = 0; f < fans.count; ++f) {
    const std::uint32_t lanes = lanes_of_fan(rays, f);
    if (lanes == 0) continue;
    if (std::popcount(lanes) >= std::popcount(near)) {
      for (std::uint32_t left = near; left != 0; left &= left - 1) {
        const int child = std::countr_zero(left);
        met[child] |= bits_of_fan(lanes & meet_box(boxes, child, fans, f), f);
      }
      continue;
    }
    for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
      const int ray = f * batch_size + std::countr_zero(left);
      for (std::uint32_t some = near & meet_boxes(boxes, fans, ray); some != 0; some &= some - 1)
        met[std::countr_zero(some)] |= RayBits{1} << ray;
    }
  }
}

// Planes through the origin and the edges of eight triangles.
struct EdgePlanes {
  alignas(32) float n[3][3][bvh_width];  // [edge][axis][triangle]
  alignas(32) float volume[bvh_width];   // (b - a) x (c - a) . a
  std::uint32_t near;                    // triangles whose planes are within the reach
};

SIMD_INLINE void edge_planes(const BvhTriangles& block, const Fans& fans, EdgePlanes& out) {
  Pack3<Float8> p[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = {load<Float8>(block.corner[k][0]) - broadcast<Float8>(fans.origin[0]),
            load<Float8>(block.corner[k][1]) - broadcast<Float8>(fans.origin[1]),
            load<Float8>(block.corner[k][2]) - broadcast<Float8>(fans.origin[2])};
  }
  const Pack3<Float8> n[3] = {cross(p[1], p[2]), cross(p[2], p[0]), cross(p[0], p[1])};
  for (int k = 0; k < 3; ++k)
    store(n[k].x, out.n[k][0]), store(n[k].y, out.n[k][1]), store(n[k].z, out.n[k][2]);
  const Pack3<Float8> normal = cross(Pack3<Float8>{p[1].x - p[0].x, p[1].y - p[0].y, p[1].z - p[0].z},
                                     Pack3<Float8>{p[2].x - p[0].x, p[2].y - p[0].y, p[2].z - p[0].z});
  const Float8 volume = dot_unfused(normal, p[0]);
  store(volume, out.volume);
  const Float8 farthest = broadcast<Float8>(fans.reach * (1 + 0x1p-10f));
  out.near = bits(le(volume * volume, farthest * farthest * dot_unfused(normal, normal)));
}

// Which rays, or triangles, are inside the planes: on one side of all three.
template <class P>
SIMD_INLINE auto inside(const P& u, const P& v, const P& w) {
  const P zero = broadcast<P>(0.0f);
  return le(zero, min(u, min(v, w))) | le(max(u, max(v, w)), zero);
}

// A fan and a triangle of the block. Returns whether a ray met it.
SIMD_INLINE bool meet_triangle(const EdgePlanes& planes, int i, Fans& fans, int fan) {
  const int at = fan * batch_size;
  const Pack3<Float16> d{load<Float16>(fans.direction[0] + at), load<Float16>(fans.direction[1] + at),
                         load<Float16>(fans.direction[2] + at)};
  const auto side = [&](int edge) {
    return dot_unfused(d,
                       broadcast3<Float16>(planes.n[edge][0][i], planes.n[edge][1][i], planes.n[edge][2][i]));
  };
  const Float16 u = side(0), v = side(1), w = side(2);
  const auto in = inside(u, v, w);
  if (!any(in)) return false;
  const Float16 zero = broadcast<Float16>(0.0f), before = load<Float16>(fans.distance + at);
  const Float16 sum = (u + v) + w, t = broadcast<Float16>(planes.volume[i]) / sum;
  const auto hit = in & lt(zero, t) & lt(t, before);
  store(select(hit, t, before), fans.distance + at);
  store(select(hit, zero - sum, load<Float16>(fans.facing + at)), fans.facing + at);
  return any(hit);
}

// A ray and all triangles of the block: the same operations, so the same bits.
SIMD_INLINE bool meet_triangles(const EdgePlanes& planes, Fans& fans, int ray) {
  const Pack3<Float8> d =
      broadcast3<Float8>(fans.direction[0][ray], fans.direction[1][ray], fans.direction[2][ray]);
  const auto side = [&](int edge) {
    return dot_unfused(d, Pack3<Float8>{load<Float8>(planes.n[edge][0]), load<Float8>(planes.n[edge][1]),
                                        load<Float8>(planes.n[edge][2])});
  };
  const Float8 u = side(0), v = side(1), w = side(2);
  const auto in = inside(u, v, w);
  if ((bits(in) & planes.near) == 0) return false;
  const Float8 sum = (u + v) + w, t = load<Float8>(planes.volume) / sum;
  const auto hit = in & lt(broadcast<Float8>(0.0f), t) & lt(t, broadcast<Float8>(fans.distance[ray]));
  std::uint32_t left = bits(hit) & planes.near;
  if (left == 0) return false;
  alignas(32) float distance[bvh_width], sums[bvh_width];
  store(t, distance), store(sum, sums);
  for (; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    if (distance[i] < fans.distance[ray]) fans.distance[ray] = distance[i], fans.facing[ray] = 0 - sums[i];
  }
  return true;
}

// A triangle at a time or a ray at a time, whichever takes fewer tests.
SIMD_INLINE void meet_block(const BvhTriangles& block, Fans& fans, RayBits rays) {
  EdgePlanes planes;
  edge_planes(block, fans, planes);
  bool met = false;
  for (int f = 0; f < fans.count; ++f) {
    const std::uint32_t lanes = lanes_of_fan(rays, f);
    if (std::popcount(lanes) < std::popcount(planes.near)) {
      for (std::uint32_t left = lanes; left != 0; left &= left - 1)
        met |= meet_triangles(planes, fans, f * batch_size + std::countr_zero(left));
    } else {
      for (std::uint32_t left = planes.near; left != 0; left &= left - 1)
        met |= meet_triangle(planes, std::countr_zero(left), fans, f);
    }
  }
  if (met) find_reach(fans);
}

// Square of the reach with room for rounding; finite, so that the boxes of empty places (infinitely far) stay
// out.
SIMD_INLINE float limit(const Fans& fans) {
  return std::min(fans.reach * fans.reach * (1 + 0x1p-18f), std::numeric_limits<float>::max());
}

struct Entry {
  float square;
  std::uint32_t child;
  RayBits rays;
};

void traverse(const TriangleBvh& bvh, Fans& fans) {
  Entry stack[bvh_depth * (bvh_width - 1) + 1];
  int size = 0;
  stack[size++] = {0, 0, fans.rays};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.square <= limit(fans))) continue;
    if (entry.child & bvh_leaf) {
      meet_block(bvh.blocks[entry.child & ~bvh_leaf], fans, entry.rays);
      continue;
    }
    const BvhNode& node = bvh.nodes[entry.child];
    Boxes boxes;
    look_at_boxes(node, fans, boxes);
    const std::uint32_t near = bits(le(load<Float8>(boxes.square), broadcast<Float8>(limit(fans))));
    RayBits met[bvh_width];
    meet_children(boxes, fans, entry.rays, near, met);
    const int base = size;
    for (std::uint32_t left = near; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      if (met[i] == 0) continue;
      int place = size++;
      for (; place > base && stack[place - 1].square < boxes.square[i]; --place)
        stack[place] = stack[place - 1];
      stack[place] = {boxes.square[i], node.child[i], met[i]};
    }
  }
}

void closest_fans(const TriangleBvh& bvh, std::span<const RayBatch> rays, float* distance, float* facing) {
  Fans fans;
  for (std::size_t first = 0; first < rays.size(); first += fans_at_once) {
    start(rays.subspan(first, std::min(fans_at_once, rays.size() - first)), distance + first * batch_size,
          fans);
    if (!bvh.nodes.empty()) traverse(bvh, fans);
    const auto end = static_cast<std::size_t>(fans.count * batch_size);
    std::copy_n(fans.distance, end, distance + first * batch_size);
    if (facing != nullptr) std::copy_n(fans.facing, end, facing + first * batch_size);
  }
}

}  // namespace

ClosestFans closest_fans_kernel() {
  return closest_fans;
}

}  // namespace tenebra::trees::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::trees {

ClosestFans closest_fans(SimdLevel level) {
  return TENEBRA_DISPATCH(level, closest_fans_kernel)();
}

}  // namespace tenebra::trees
#endif
