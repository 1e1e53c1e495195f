// Vectors in double, eight at a time. Products and sums are not fused: the same bits on every instruction
// set. Included once per target.
#if defined(TENEBRA_SIMD_DOUBLE8_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SIMD_DOUBLE8_INL_H_
#undef TENEBRA_SIMD_DOUBLE8_INL_H_
#else
#define TENEBRA_SIMD_DOUBLE8_INL_H_
#endif

#include <glm/glm.hpp>

#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::simd::HWY_NAMESPACE {

using Double8 = Pack<double, 8>;
using Vector8 = Pack3<Double8>;

SIMD_INLINE Double8 broadcast8(double value) {
  return broadcast<Double8>(value);
}
SIMD_INLINE Vector8 broadcast8(const glm::dvec3& v) {
  return broadcast3<Double8>(v.x, v.y, v.z);
}
SIMD_INLINE Double8 dot_unfused(const Vector8& a, const Vector8& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// L1 norm.
SIMD_INLINE Double8 l1_norm(const Vector8& v) {
  return abs(v.x) + abs(v.y) + abs(v.z);
}
SIMD_INLINE Vector8 operator+(const Vector8& a, const Vector8& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SIMD_INLINE Vector8 operator*(Double8 s, const Vector8& a) {
  return {s * a.x, s * a.y, s * a.z};
}
SIMD_INLINE Vector8 select3(const Mask<double, 8>& t, const Vector8& a, const Vector8& b) {
  return {select(t, a.x, b.x), select(t, a.y, b.y), select(t, a.z, b.z)};
}

}  // namespace tenebra::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
