// Boxes and triangles against the rays of one slot of a node of tiles, sixteen at a time, in float: as few
// rays are looked at whose neighbours lie apart. Conservative: what is rejected can block no ray of the slot.
// u = 2^-24 below. Included once per target.
#if defined(TENEBRA_SLOT_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SLOT_TESTS_INL_H_
#undef TENEBRA_SLOT_TESTS_INL_H_
#else
#define TENEBRA_SLOT_TESTS_INL_H_
#endif

#include "shadow/tiles/face_tests-inl.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// The slots of a node of tiles as rays with a width: at the depth z they are within du z of u z, and so for
/// v. To du comes what roundings here are worth.
struct SlotRays {
  alignas(64) float u[16], v[16], du[16], dv[16];
  float inverse_u[16], inverse_v[16];  ///< of values that are not 0
  float z[16];                         ///< largest
};

/// The middle m of a range and half its width. Roundings below move a coordinate by at most 6u z and 4u of
/// itself: 12u more where it is at most 8 z (where it is more, the ray is far). The middle is off by 3u.
HWY_INLINE void aim_range(const float* low, const float* high, float* middle, float* inverse, float* width) {
  const Float16 half = splat<Float16>(0.5f), least = splat<Float16>(1e-18f);
  Float16 m = (load<Float16>(low) + load<Float16>(high)) * half;
  m = where_not_above(absolute(m), least, least, m);
  store(m, middle), store(splat<Float16>(1.0f) / m, inverse);
  store((load<Float16>(high) - load<Float16>(low)) * half + splat<Float16>(48 * u), width);
}

HWY_INLINE void aim_slots(const RayNode& n, SlotRays& out) {
  aim_range(n.u0, n.u1, out.u, out.inverse_u, out.du);
  aim_range(n.v0, n.v1, out.v, out.inverse_v, out.dv);
  store(splat<Float16>(1 + 4 * u) / load<Float16>(n.w), out.z);
}

/// Sixteen boxes relative to the light, along a face's axes.
struct FrontBoxes {
  Float16 low[3], high[3];
};

HWY_INLINE FrontBoxes boxes_in_front(const BoxNode& node, const glm::vec3& light, const Face& face) {
  FrontBoxes b;
  for (int k = 0; k < 3; ++k) {
    const int axis = face.axes[k];
    b.low[k] = load<Float16>(node.low[axis]) - splat<Float16>(light[axis]);
    b.high[k] = load<Float16>(node.high[axis]) - splat<Float16>(light[axis]);
  }
  if (face.sign > 0) return b;
  const Float16 zero = splat<Float16>(0.0f), low = b.low[2];
  b.low[2] = zero - b.high[2], b.high[2] = zero - low;
  return b;
}

/// Bits of the boxes that a slot's rays may meet: the depths at which they are between both pairs of sides.
HWY_INLINE std::uint32_t boxes_met(const FrontBoxes& b, const SlotRays& rays, int slot) {
  const Float16 far = min(b.high[2], splat<Float16>(rays.z[slot])), tiny = splat<Float16>(next_to_the_light);
  Float16 enter = max(b.low[2], splat<Float16>(0.0f)), leave = far;
  const float* const inverse[2] = {rays.inverse_u, rays.inverse_v};
  const float* const width[2] = {rays.du, rays.dv};
  for (int k = 0; k < 2; ++k) {
    const Float16 by = splat<Float16>(inverse[k][slot]),
                  margin = multiply_add(splat<Float16>(width[k][slot]), far, tiny);
    const Float16 from = (b.low[k] - margin) * by, to = (b.high[k] + margin) * by;
    enter = max(enter, min(from, to)), leave = min(leave, max(from, to));
  }
  return 0xffffu & ~less_bits(leave * splat<Float16>(1 + 16 * u), enter);
}

/// A cluster's triangles relative to the light, along a face's axes.
struct FrontTriangles {
  Float16 x[3], y[3], z[3];
  Float16 near, far;  ///< least and largest z
  Float16 reach;      ///< largest |z|
};

HWY_INLINE FrontTriangles triangles_in_front(const TriangleCluster& c, const glm::vec3& light,
                                             const Face& face) {
  const float(*const corners[3])[16] = {c.x, c.y, c.z};
  const Float16 sign = splat<Float16>(face.sign);
  const Pack3<Float16> origin =
      splat3<Float16>(light[face.axes[0]], light[face.axes[1]], light[face.axes[2]]);
  FrontTriangles t;
  for (int k = 0; k < 3; ++k) {
    t.x[k] = load<Float16>(corners[face.axes[0]][k]) - origin.x;
    t.y[k] = load<Float16>(corners[face.axes[1]][k]) - origin.y;
    t.z[k] = (load<Float16>(corners[face.axes[2]][k]) - origin.z) * sign;
  }
  t.near = min(t.z[0], min(t.z[1], t.z[2])), t.far = max(t.z[0], max(t.z[1], t.z[2]));
  t.reach = max(absolute(t.near), absolute(t.far));
  return t;
}

/// Bits of the triangles that may block rays of a slot. Sheared along z by the middle ray they are seen end
/// on: the ray is the origin, or somewhere in a rectangle around it. A shear is linear: corners behind the
/// light need no care.
HWY_INLINE std::uint32_t triangles_met(const FrontTriangles& t, const SlotRays& rays, int slot) {
  const Float16 zero = splat<Float16>(0.0f), tiny = splat<Float16>(next_to_the_light);
  const Float16 du = multiply_add(splat<Float16>(rays.du[slot]), t.reach, tiny),
                dv = multiply_add(splat<Float16>(rays.dv[slot]), t.reach, tiny);
  Float16 x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = t.x[k] - splat<Float16>(rays.u[slot]) * t.z[k];
    y[k] = t.y[k] - splat<Float16>(rays.v[slot]) * t.z[k];
  }
  const Float16 x0 = min(x[0], min(x[1], x[2])), x1 = max(x[0], max(x[1], x[2]));
  const Float16 y0 = min(y[0], min(y[1], y[2])), y1 = max(y[0], max(y[1], y[2]));
  const auto beside = less(du, x0) | less(x1, zero - du) | less(dv, y0) | less(y1, zero - dv) |
                      less(splat<Float16>(rays.z[slot]), t.near) | less(t.far, zero);
  const std::uint32_t met = 0xffffu & ~bits(beside);
  if (met == 0) return 0;
  // Twice the areas that the origin makes with the edges. With corners off by du + 4u |x| and dv + 4u |y| each
  // is off by twice du |y| + dv |x| + du dv and 16u |x| |y|, and by 3u |x| |y| twice from its own roundings.
  const Float16 wide = max(absolute(x0), absolute(x1)), high = max(absolute(y0), absolute(y1));
  const Float16 two = splat<Float16>(2 + 16 * u);
  const Float16 off = multiply_add(two, multiply_add(du, high + dv, dv * wide),
                                   multiply_add(splat<Float16>(32 * u) * wide, high, splat<Float16>(0x1p-120f)));
  const auto area = [&](int i, int k) HWY_ATTR { return x[i] * y[k] - x[k] * y[i]; };
  const Float16 a = area(0, 1), b = area(1, 2), c = area(2, 0);
  const auto outside = less(min(a, min(b, c)), zero - off) & less(off, max(a, max(b, c)));
  return met & ~bits(outside);
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
