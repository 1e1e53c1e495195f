// Normal maps at sixteen samples. Nothing is fused: the same bits on every instruction set. Included once per
// target.
#if defined(TENEBRA_SHADE_BEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SHADE_BEND_INL_H_
#undef TENEBRA_SHADE_BEND_INL_H_
#else
#define TENEBRA_SHADE_BEND_INL_H_
#endif

#include "shade/diffuse-inl.h"
#include "simd/powers-inl.h"
#include "texture/sampler.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shade::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

SIMD_INLINE Vector16 cross_unfused(const Vector16& a, const Vector16& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A normal stays as it is where it is zero, where its tangent has no direction across it, and where the map
/// holds no direction.
inline void bend(float scale, const texture::TextureValues& map, const texture::TextureValues& tangents,
                 std::size_t first, std::size_t count, SampleBlock& b) {
  const Float16 one = number(1.0f), two = number(2.0f), least = number(1e-6f);
  for (std::size_t i = first; i < first + count; i += 16) {
    const auto at = [i](const texture::TextureValues& of, int c) { return load<Float16>(of.channel[c] + i); };
    const Vector16 normal = load3(b.normal, i), along{at(tangents, 0), at(tangents, 1), at(tangents, 2)};
    const Vector16 across = along - dot_unfused(along, normal) * normal;
    const Float16 length = sqrt(dot_unfused(across, across));
    const Vector16 x = (one / max(length, least)) * across;
    const Vector16 y = copy_sign(one, at(tangents, 3)) * cross_unfused(normal, x);
    const Vector16 bent = (number(scale) * (two * at(map, 0) - one)) * x +
                          (number(scale) * (two * at(map, 1) - one)) * y + (two * at(map, 2) - one) * normal;
    const Float16 size = sqrt(dot_unfused(bent, bent));
    const auto usable = lt(least, length) & lt(least, size) & lt(least, dot_unfused(normal, normal));
    store3(select3(usable, (one / max(size, least)) * bent, normal), b.normal, i);
  }
}

}  // namespace tenebra::shade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
