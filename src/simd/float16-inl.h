// Vectors in float, sixteen at a time. Products and sums are not fused: the same bits on every instruction
// set. Included once per target.
#if defined(TENEBRA_SIMD_FLOAT16_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SIMD_FLOAT16_INL_H_
#undef TENEBRA_SIMD_FLOAT16_INL_H_
#else
#define TENEBRA_SIMD_FLOAT16_INL_H_
#endif

#include <glm/glm.hpp>

#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::simd::HWY_NAMESPACE {

using Vector16 = Pack3<Float16>;

SIMD_INLINE Vector16 broadcast16(const glm::vec3& v) {
  return broadcast3<Float16>(v.x, v.y, v.z);
}
SIMD_INLINE Float16 dot_unfused(const Vector16& a, const Vector16& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
SIMD_INLINE Vector16 operator+(const Vector16& a, const Vector16& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SIMD_INLINE Vector16 operator*(Float16 s, const Vector16& a) {
  return {s * a.x, s * a.y, s * a.z};
}
SIMD_INLINE Vector16 select3(const Mask<float, 16>& t, const Vector16& a, const Vector16& b) {
  return {select(t, a.x, b.x), select(t, a.y, b.y), select(t, a.z, b.z)};
}

}  // namespace tenebra::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
