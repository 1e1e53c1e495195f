// Specular reflection at sixteen samples: Phong's and GGX's lobes, and the surroundings' mirror image. The
// formulas are in docs/materials.md. Nothing is fused: the same bits on every instruction set. Included once
// per target.
#if defined(TENEBRA_SHADE_GLOSS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SHADE_GLOSS_INL_H_
#undef TENEBRA_SHADE_GLOSS_INL_H_
#else
#define TENEBRA_SHADE_GLOSS_INL_H_
#endif

#include "shade/diffuse-inl.h"
#include "simd/powers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shade::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// What gloss needs of a sample.
struct Gloss {
  Vector16 normal, to_eye, specular;
  Float16 roughness, exponent, grazing;
  Mask<float, 16> ggx;
};
SIMD_INLINE Gloss gloss_of(const SampleBlock& b, std::size_t i) {
  const Float16 roughness = load<Float16>(b.roughness + i);
  return {load3(b.normal, i),
          load3(b.to_eye, i),
          load3(b.specular, i),
          max(roughness, number(0.0f)),
          load<Float16>(b.exponent + i),
          load<Float16>(b.grazing + i),
          le(number(0.0f), roughness)};
}
SIMD_INLINE Vector16 mirrored(const Gloss& g) {
  const Float16 twice = number(2.0f) * dot_unfused(g.normal, g.to_eye);
  return twice * g.normal - g.to_eye;
}
SIMD_INLINE Vector16 unit(const Vector16& v) {
  return (number(1.0f) / max(sqrt(dot_unfused(v, v)), number(1e-30f))) * v;
}

/// A direction that stands for the whole light, and the distance of the light there.
struct Towards {
  Vector16 direction;
  Float16 distance;
};

/// The place of the polygon nearest to where the mirrored ray meets its plane.
SIMD_INLINE Towards towards_polygon(const LightTerms& terms, const Gloss& g, const Vector16& point) {
  const Vector16 ray = mirrored(g), normal = broadcast16(terms.area_normal);
  const Vector16 from_centre = number(terms.area_weight) * point - broadcast16(terms.area_from_eye);
  const Float16 side = dot_unfused(normal, from_centre), height = abs(side);
  // The way towards the plane, from whichever side.
  const Float16 sinking =
      max(number(0.0f) - copy_sign(number(1.0f), side) * dot_unfused(normal, ray), number(0.05f));
  const Vector16 met = from_centre + (height / sinking) * ray;
  const Float16 x = dot_unfused(broadcast16(terms.axis_x), met),
                y = dot_unfused(broadcast16(terms.axis_y), met);
  Float16 near_x = x, near_y = y, nearest = number(3e38f), inside = number(1.0f);
  for (int k = 0; k < terms.corner_count; ++k) {
    const auto at = static_cast<std::size_t>(k),
               next = static_cast<std::size_t>((k + 1) % terms.corner_count);
    const glm::vec2 a = terms.corners[at], edge = terms.corners[next] - a;
    const Float16 wx = x - number(a.x), wy = y - number(a.y), ex = number(edge.x), ey = number(edge.y);
    const Float16 along = clamped((wx * ex + wy * ey) * number(1.0f / glm::dot(edge, edge)), 0.0f, 1.0f);
    const Float16 gap_x = wx - along * ex, gap_y = wy - along * ey, gap = gap_x * gap_x + gap_y * gap_y;
    inside = min(inside, ex * wy - ey * wx);
    const Mask<float, 16> nearer = lt(gap, nearest);
    near_x = select(nearer, x - gap_x, near_x);
    near_y = select(nearer, y - gap_y, near_y);
    nearest = min(nearest, gap);
  }
  const Mask<float, 16> within = le(number(0.0f), inside);
  near_x = select(within, x, near_x);
  near_y = select(within, y, near_y);
  const Vector16 path = near_x * broadcast16(terms.axis_x) + near_y * broadcast16(terms.axis_y) - from_centre;
  const Float16 distance = sqrt(dot_unfused(path, path));
  return {(number(1.0f) / max(distance, number(1e-30f))) * path, distance};
}

/// Share of light that is mirrored at angle cosine `cosine` (Schlick).
SIMD_INLINE Vector16 fresnel(const Gloss& g, Float16 cosine) {
  const Float16 x = number(1.0f) - cosine, x2 = x * x, rise = x2 * x2 * x;
  const Vector16 at_90{g.grazing, g.grazing, g.grazing};
  return g.specular + rise * (at_90 - g.specular);
}

/// pi * D * V of GGX, with the height-correlated shadowing of Smith.
SIMD_INLINE Float16 ggx_lobe(const Gloss& g, const Vector16& to_light, Float16 half_cosine,
                             Float16 widened_by) {
  const Float16 one = number(1.0f);
  const Float16 alpha = max(g.roughness * g.roughness, number(1e-3f)), a2 = alpha * alpha;
  const Float16 at_light = clamped(dot_unfused(g.normal, to_light), 1e-4f, 1.0f),
                at_eye = clamped(dot_unfused(g.normal, g.to_eye), 1e-4f, 1.0f);
  const Float16 spread = half_cosine * half_cosine * (a2 - one) + one;
  const Float16 rest = one - a2;
  const Float16 masking =
      at_light * sqrt(a2 + rest * at_eye * at_eye) + at_eye * sqrt(a2 + rest * at_light * at_light);
  const Float16 wider = alpha / min(alpha + widened_by, one);
  return wider * wider * a2 / (spread * spread) * (number(0.5f) / masking);
}

/// As diffuse_light, with what is mirrored added and, by GGX, taken from what is diffuse.
SIMD_INLINE Vector16 glossy_light(const LightTerms& terms, const Incident& incident, const SampleBlock& b,
                                  std::size_t i) {
  const Gloss g = gloss_of(b, i);
  const Float16 zero = number(0.0f), one = number(1.0f);
  Towards to{incident.to_light, one};
  if (terms.by_irradiance) to = towards_polygon(terms, g, load3(b.point, i));
  const Float16 weight = received(terms, incident, b, i);
  const Vector16 half = unit(to.direction + g.to_eye);
  const Float16 half_cosine = clamped(dot_unfused(g.normal, half), 0.0f, 1.0f);
  const Vector16 share = fresnel(g, clamped(dot_unfused(g.to_eye, half), 0.0f, 1.0f));
  const Float16 widened = number(0.5f * terms.radius_m) / max(to.distance, number(1e-30f));
  const Float16 cosine = dot_unfused(g.normal, to.direction);
  const Float16 lobe =
      select(lt(zero, cosine), weight * ggx_lobe(g, to.direction, half_cosine, widened), zero);

  // Phong's highlight has no cosine at the surface; irradiance contains it, so it is divided by it again.
  const Float16 bare =
      terms.by_irradiance
          ? incident.fade / max(dot_unfused(unbent_normal(b, i), incident.to_light), number(0.25f))
          : incident.fade;
  const Float16 aligned = dot_unfused(mirrored(g), to.direction);
  const Float16 power = exp2_of(g.exponent * log2_of(clamped(aligned, 1e-30f, 1.0f)));
  const Float16 highlight = select(lt(zero, aligned) & lt(zero, weight), bare * power, zero);

  const Float16 mirror = select(g.ggx, lobe, highlight);
  const Vector16 by = select3(g.ggx, share, g.specular);
  const Float16 most = number(brightest);
  const auto channel = [&](Float16 base, Float16 fraction, float color) {
    const Float16 diffuse = base * select(g.ggx, one - fraction, one) * weight;
    const Float16 sum = number(color) * (diffuse + fraction * mirror);
    return select(lt(zero, weight), min(sum, most), zero);
  };
  const Vector16 base = load3(b.base, i);
  return {channel(base.x, by.x, terms.color.x), channel(base.y, by.y, terms.color.y),
          channel(base.z, by.z, terms.color.z)};
}

/// Share of uniform surroundings that GGX mirrors to the eye: Karis' fit of the integral (2014).
SIMD_INLINE Vector16 mirrored_share(const Gloss& g) {
  const Float16 r = g.roughness, one = number(1.0f);
  const Float16 at_eye = clamped(dot_unfused(g.normal, g.to_eye), 0.0f, 1.0f);
  const Float16 x = one - r, y = number(0.0425f) - number(0.0275f) * r,
                z = number(1.04f) - number(0.572f) * r, w = number(0.022f) * r - number(0.04f);
  const Float16 edge = min(x * x, exp2_of(number(-9.28f) * at_eye)) * x + y;
  const Float16 scale = number(-1.04f) * edge + z,
                offset = max(number(1.04f) * edge + w, number(0.0f)) * g.grazing;
  return {g.specular.x * scale + offset, g.specular.y * scale + offset, g.specular.z * scale + offset};
}

/// Ambient light where all is open: what is diffuse, and by GGX also the surroundings' mirror image.
SIMD_INLINE Vector16 glossy_ambient(const SampleBlock& b, std::size_t i) {
  const Gloss g = gloss_of(b, i);
  const Vector16 share = mirrored_share(g), around = load3(b.reflected, i), diffuse = load3(b.ambient, i);
  const Float16 one = number(1.0f);
  const Vector16 both{(one - share.x) * diffuse.x + share.x * around.x,
                      (one - share.y) * diffuse.y + share.y * around.y,
                      (one - share.z) * diffuse.z + share.z * around.z};
  return select3(g.ggx, both, diffuse);
}

}  // namespace tenebra::shade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
