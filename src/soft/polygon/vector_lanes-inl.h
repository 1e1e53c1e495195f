// Vectors in double, eight at a time. Products and sums are not fused: the same bits on every instruction
// set. Included once per target.
#if defined(TENEBRA_SOFT_VECTOR_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_VECTOR_LANES_INL_H_
#undef TENEBRA_SOFT_VECTOR_LANES_INL_H_
#else
#define TENEBRA_SOFT_VECTOR_LANES_INL_H_
#endif

#include <glm/glm.hpp>

#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

using Double8 = Pack<double, 8>;
using Vector8 = Pack3<Double8>;

SIMD_INLINE Double8 all(double value) {
  return splat<Double8>(value);
}
SIMD_INLINE Vector8 all(const glm::dvec3& v) {
  return splat3<Double8>(v.x, v.y, v.z);
}
SIMD_INLINE Double8 product(const Vector8& a, const Vector8& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
SIMD_INLINE Vector8 operator+(const Vector8& a, const Vector8& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SIMD_INLINE Vector8 operator*(Double8 s, const Vector8& a) {
  return {s * a.x, s * a.y, s * a.z};
}
SIMD_INLINE Vector8 choose3(const Truth<double, 8>& t, const Vector8& a, const Vector8& b) {
  return {choose(t, a.x, b.x), choose(t, a.y, b.y), choose(t, a.z, b.z)};
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
