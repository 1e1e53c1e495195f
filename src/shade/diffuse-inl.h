// Direct light at sixteen samples: what arrives, and what diffuse surfaces make of it. Nothing is fused: the
// same bits on every instruction set. Included once per target.
#if defined(TENEBRA_SHADE_DIFFUSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SHADE_DIFFUSE_INL_H_
#undef TENEBRA_SHADE_DIFFUSE_INL_H_
#else
#define TENEBRA_SHADE_DIFFUSE_INL_H_
#endif

#include "shade/light_terms.h"
#include "shade/sample_block.h"
#include "simd/float16-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shade::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

// A light that touches a surface is infinitely bright there; infinity times a mask of 0 would not be 0.
constexpr float brightest = 1e30f;

SIMD_INLINE Vector16 load3(const SampleBlock::Channel (&from)[3], std::size_t i) {
  return {load<Float16>(from[0] + i), load<Float16>(from[1] + i), load<Float16>(from[2] + i)};
}
SIMD_INLINE void store3(const Vector16& v, SampleBlock::Channel (&to)[3], std::size_t i) {
  store(v.x, to[0] + i), store(v.y, to[1] + i), store(v.z, to[2] + i);
}

/// Light on its way to sixteen samples. `fade` is 0 where nothing arrives.
struct Incident {
  Vector16 to_light;  ///< unit
  Float16 fade;
};

/// Fading with distance and angle; finite.
SIMD_INLINE Float16 fade_of(const LightTerms& terms, const Vector16& to_light, Float16 distance) {
  const Float16 zero = broadcast<Float16>(0.0f), one = broadcast<Float16>(1.0f);
  Float16 fade = one;
  if (terms.spot || terms.cosine_emitter) {
    const Float16 cosine = zero - dot_unfused(broadcast16(terms.direction), to_light);
    if (terms.spot) {
      const Float16 cone = cosine * broadcast<Float16>(terms.cone.x) + broadcast<Float16>(terms.cone.y);
      fade = min(max(cone, zero), one);
      fade = fade * fade;
    }
    if (terms.cosine_emitter) fade = fade * max(cosine, zero);
  }
  if (terms.range_m > 0) {
    const Float16 near = distance / broadcast<Float16>(terms.range_m), square = near * near;
    fade = fade * min(max(one - square * square, zero), one);
  }
  if (terms.distance_power < 0) fade = fade / (distance * distance);
  if (terms.distance_power > 0) fade = fade * (distance * distance);
  return min(fade, broadcast<Float16>(brightest));
}

SIMD_INLINE Incident incident_light(const LightTerms& terms, const SampleBlock& b, std::size_t i) {
  if (terms.directional) {
    const Vector16 to_light = broadcast16(-terms.direction);
    return {to_light, broadcast<Float16>(1.0f)};
  }
  const Vector16 path = broadcast16(terms.from_eye) - load3(b.point, i);
  const Float16 distance = sqrt(dot_unfused(path, path)), zero = broadcast<Float16>(0.0f);
  const Vector16 to_light = (broadcast<Float16>(1.0f) / distance) * path;
  return {to_light, select(lt(zero, distance), fade_of(terms, to_light, distance), zero)};
}

/// The normal that irradiance was found with.
SIMD_INLINE Vector16 unbent_normal(const SampleBlock& b, std::size_t i) {
  return load3(b.keeps_unbent ? b.unbent : b.normal, i);
}

/// What bending the normal makes of irradiance: as much more or less as of light from `to_light`; 1 where
/// nothing bends. Where that light grazes the unbent surface, it counts as one at a cosine of 0.25.
SIMD_INLINE Float16 turned_by_bend(const Vector16& to_light, const SampleBlock& b, std::size_t i) {
  const Float16 before = dot_unfused(unbent_normal(b, i), to_light),
                after = dot_unfused(load3(b.normal, i), to_light);
  const Float16 change = (after - before) / max(before, broadcast<Float16>(0.25f));
  return max(broadcast<Float16>(1.0f) + change, broadcast<Float16>(0.0f));
}

/// How much of the arriving light a surface receives: fade times the cosine at the surface; zero where the
/// light is not before it.
SIMD_INLINE Float16 received(const LightTerms& terms, const Incident& incident, const SampleBlock& b,
                             std::size_t i) {
  if (terms.by_irradiance)
    return b.keeps_unbent ? incident.fade * turned_by_bend(incident.to_light, b, i) : incident.fade;
  const Float16 zero = broadcast<Float16>(0.0f);
  const Float16 cosine = max(dot_unfused(load3(b.normal, i), incident.to_light), zero);
  const Float16 above = dot_unfused(load3(b.before, i), incident.to_light);
  return select(lt(zero, above), cosine * incident.fade, zero);
}

SIMD_INLINE Vector16 diffuse_light(const LightTerms& terms, const Incident& incident, const SampleBlock& b,
                                   std::size_t i) {
  const Float16 weight = received(terms, incident, b, i), zero = broadcast<Float16>(0.0f);
  const Vector16 base = load3(b.base, i);
  const Float16 most = broadcast<Float16>(brightest);
  const Vector16 light{min(base.x * broadcast<Float16>(terms.color.x) * weight, most),
                       min(base.y * broadcast<Float16>(terms.color.y) * weight, most),
                       min(base.z * broadcast<Float16>(terms.color.z) * weight, most)};
  return select3(lt(zero, weight), light, {zero, zero, zero});
}

}  // namespace tenebra::shade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
