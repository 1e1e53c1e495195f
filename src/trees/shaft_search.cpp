#include "trees/shaft_search.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/shaft_search.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tenebra::trees::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using Float8 = Pack<float, bvh_width>;

// Bits of the boxes, by their planes as in a node, that may meet the shaft.
SIMD_INLINE std::uint32_t boxes_met(const float (*planes)[bvh_width], const FloatShaft& shaft) {
  Mask<float, bvh_width> apart = lt(broadcast<Float8>(shaft.high[0]), load<Float8>(planes[0])) |
                                 lt(load<Float8>(planes[3]), broadcast<Float8>(shaft.low[0]));
  for (int axis = 1; axis < 3; ++axis) {
    apart = apart | lt(broadcast<Float8>(shaft.high[axis]), load<Float8>(planes[axis])) |
            lt(load<Float8>(planes[3 + axis]), broadcast<Float8>(shaft.low[axis]));
  }
  for (int p = 0; p < shaft.count; ++p) {
    const FloatShaft::Plane& plane = shaft.planes[p];
    const Float8 value = mul_add(broadcast<Float8>(plane.m), load<Float8>(planes[plane.i]),
                                 broadcast<Float8>(plane.n) * load<Float8>(planes[plane.j]));
    apart = apart | lt(broadcast<Float8>(plane.limit), value);
  }
  return ~bits(apart) & 0xffu;
}

SIMD_INLINE std::uint32_t triangles_met(const BvhTriangles& block, const FloatShaft& shaft) {
  alignas(64) float planes[6][bvh_width];
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 a = load<Float8>(block.corner[0][axis]), b = load<Float8>(block.corner[1][axis]),
                 c = load<Float8>(block.corner[2][axis]);
    store(min(min(a, b), c), planes[axis]);
    store(max(max(a, b), c), planes[3 + axis]);
  }
  std::uint32_t met = boxes_met(planes, shaft);
  for (int last = bvh_width - 1; last >= 0 && block.triangle[last] == no_caster; --last) met &= ~(1u << last);
  return met;
}

// Calls body(block, triangles that may meet the shaft) until it returns true; returns whether it did.
template <class Body>
bool until(const TriangleBvh& bvh, const FloatShaft& shaft, const Body& body) {
  if (bvh.nodes.empty()) return false;
  std::uint32_t stack[bvh_depth * (bvh_width - 1) + 1];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t place = stack[--size];
    if ((place & bvh_leaf) != 0) {
      const std::uint32_t block = place & ~bvh_leaf, met = triangles_met(bvh.blocks[block], shaft);
      if (met != 0 && body(block, met)) return true;
      continue;
    }
    const BvhNode& node = bvh.nodes[place];
    for (std::uint32_t met = boxes_met(node.plane, shaft); met != 0; met &= met - 1)
      stack[size++] = node.child[std::countr_zero(met)];
  }
  return false;
}

void find(const TriangleBvh& bvh, const FloatShaft& shaft, std::vector<BlockTriangles>& out) {
  until(bvh, shaft, [&](std::uint32_t block, std::uint32_t lanes) {
    out.push_back({block, lanes});
    return false;
  });
}

bool any(const TriangleBvh& bvh, const FloatShaft& shaft) {
  return until(bvh, shaft, [](std::uint32_t, std::uint32_t) { return true; });
}

}  // namespace

ShaftSearch shaft_search() {
  return {find, any};
}

}  // namespace tenebra::trees::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::trees {

ShaftSearch shaft_search(SimdLevel level) {
  return TENEBRA_DISPATCH(level, shaft_search)();
}

}  // namespace tenebra::trees
#endif
