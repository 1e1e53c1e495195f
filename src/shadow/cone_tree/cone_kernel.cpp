#include "shadow/cone_tree/cone_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/cone_tree/cone_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

// Chord cone around sixteen directions. In units of the packet's reach, so that squares stay in range. A
// float position base + q is off by 2 sqrt(3) u (|p| + r) at most, its direction after normalising by 12u +
// 4u r / |p|; lengths by a factor 1 +- 16u and 4u r.
ConeNode cone_around(const RayPacket& packet) {
  constexpr float u = 0x1p-24f;
  const float inverse = 1 / packet.reach;
  const Float16 scale = broadcast<Float16>(inverse);
  const Pack3<Float16> p{
      (broadcast<Float16>(static_cast<float>(packet.base_x)) + load<Float16>(packet.qx)) * scale,
      (broadcast<Float16>(static_cast<float>(packet.base_y)) + load<Float16>(packet.qy)) * scale,
      (broadcast<Float16>(static_cast<float>(packet.base_z)) + load<Float16>(packet.qz)) * scale};
  const Float16 length = sqrt(dot(p, p));
  const float shortest = reduce_min(length), longest = reduce_max(length);
  const float r = packet.radius * inverse;

  ConeNode node;
  node.near = std::max(0.0f, (shortest * (1 - 16 * u) - 4 * u * r) * packet.reach * (1 - 4 * u));
  node.far = (longest * (1 + 16 * u) + 4 * u * r) * packet.reach * (1 + 4 * u);
  node.w = glm::vec3(1, 0, 0);
  node.c = 4;                            // more than any chord: bounds nothing, but is finite
  if (!(shortest > 1e-6f)) return node;  // one ray begins next to the light, others far from it

  const Pack3<Float16> d{p.x / length, p.y / length, p.z / length};
  const glm::vec3 centre(reduce_min(d.x) + reduce_max(d.x), reduce_min(d.y) + reduce_max(d.y),
                         reduce_min(d.z) + reduce_max(d.z));
  const float centre_length = std::sqrt(centre.x * centre.x + centre.y * centre.y + centre.z * centre.z);
  if (centre_length > 1e-3f) node.w = centre / centre_length;
  const Pack3<Float16> apart{d.x - broadcast<Float16>(node.w.x), d.y - broadcast<Float16>(node.w.y),
                             d.z - broadcast<Float16>(node.w.z)};
  const float widest = std::sqrt(reduce_max(dot(apart, apart)));
  node.c = std::min(node.c, (1 + 8 * u) * widest + 12 * u + 4 * u * r / shortest);
  return node;
}

}  // namespace

ConeAround cone_around_kernel() {
  return cone_around;
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::shadow {

ConeAround cone_around_kernel(SimdLevel level) {
  return TENEBRA_DISPATCH(level, cone_around_kernel)();
}

}  // namespace tenebra::shadow
#endif
