// Surfaces of materials with their textures, at sixteen samples: docs/materials.md explains the parameters.
// Included once per target.
#if defined(TENEBRA_SHADE_RESOLVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SHADE_RESOLVE_INL_H_
#undef TENEBRA_SHADE_RESOLVE_INL_H_
#else
#define TENEBRA_SHADE_RESOLVE_INL_H_
#endif

#include "shade/diffuse-inl.h"
#include "shade/kernels.h"
#include "simd/powers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shade::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

inline void locate(const TriangleSetup& setup, const CoordinatePlane& plane, const SampleBlock& b,
                   std::size_t first, std::size_t count, texture::TexturePlaces& places) {
  for (std::size_t i = first; i < first + count; i += 16) {
    const Float16 u = load<Float16>(b.u + i), v = load<Float16>(b.v + i), depth = load<Float16>(b.depth + i);
    // u and v are quotients of planes of the picture by `depth`, and so are their derivatives.
    const Float16 u_x = depth * (number(setup.u.dx) - number(setup.depth.dx) * u),
                  v_x = depth * (number(setup.v.dx) - number(setup.depth.dx) * v),
                  u_y = depth * (number(setup.u.dy) - number(setup.depth.dy) * u),
                  v_y = depth * (number(setup.v.dy) - number(setup.depth.dy) * v);
    for (int c = 0; c < 2; ++c) {
      const Float16 second = number(plane.by_second[c]), third = number(plane.by_third[c]);
      store(number(plane.first[c]) + (u * second + v * third), places.at[c] + i);
      store(u_x * second + v_x * third, places.by_x[c] + i);
      store(u_y * second + v_y * third, places.by_y[c] + i);
    }
  }
}

inline void blend(const glm::vec4* colors, const SampleBlock& b, std::size_t first, std::size_t count,
                  texture::TextureValues& out) {
  for (std::size_t i = first; i < first + count; i += 16) {
    const Float16 u = load<Float16>(b.u + i), v = load<Float16>(b.v + i), rest = number(1.0f) - u - v;
    for (int c = 0; c < 4; ++c)
      store(rest * number(colors[0][c]) + u * number(colors[1][c]) + v * number(colors[2][c]),
            out.channel[c] + i);
  }
}

SIMD_INLINE Vector16 times(const Vector16& a, const Vector16& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
SIMD_INLINE Vector16 color_of(const texture::TextureValues* values, std::size_t i) {
  if (values == nullptr) return broadcast16(glm::vec3(1.0f));
  return {load<Float16>(values->channel[0] + i), load<Float16>(values->channel[1] + i),
          load<Float16>(values->channel[2] + i)};
}
SIMD_INLINE Float16 channel_of(const texture::TextureValues* values, int c, std::size_t i) {
  return values == nullptr ? number(1.0f) : load<Float16>(values->channel[c] + i);
}

/// A surface at sixteen samples.
struct Surfaces {
  Vector16 base, ambient, emissive, specular;
  Float16 roughness, exponent, grazing;
};

/// `base`: colour times `pattern`, which has the textures' share of it.
SIMD_INLINE Surfaces resolved(const Material& m, const SurfaceInputs& in, const Vector16& base,
                              const Vector16& pattern, const glm::vec3& ambient_light, std::size_t i) {
  const Float16 zero = number(0.0f), one = number(1.0f);
  const Vector16 none{zero, zero, zero};
  Surfaces s{base, none, times(broadcast16(m.emissive), color_of(in.emissive, i)), none, number(-1.0f),
             one,  one};
  switch (m.model) {
    case SurfaceModel::phong:
      s.specular = times(broadcast16(m.specular), color_of(in.specular, i));
      s.exponent = number(std::max(m.phong_exponent, 0.0f)) * channel_of(in.gloss, 0, i);
      break;
    case SurfaceModel::metallic_roughness: {
      const Float16 metallic = number(m.metallic) * channel_of(in.gloss, 2, i);
      const Float16 rest = one - metallic;
      const Float16 share = number(m.specular_share) * channel_of(in.specular_share, 3, i);
      const Vector16 at_0 = times(broadcast16(m.dielectric), color_of(in.specular, i));
      s.specular = share * Vector16{min(at_0.x, one), min(at_0.y, one), min(at_0.z, one)};
      s.specular = rest * s.specular + metallic * base;
      s.grazing = one - rest * (one - share);
      s.base = rest * base;
      s.roughness = clamped(number(m.roughness) * channel_of(in.gloss, 1, i), 0.0f, 1.0f);
      break;
    }
    case SurfaceModel::specular_glossiness: {
      s.specular = times(broadcast16(m.specular), color_of(in.specular, i));
      s.base = (one - max(max(s.specular.x, s.specular.y), s.specular.z)) * base;
      const Float16 glossiness = number(1 - m.roughness) * channel_of(in.specular, 3, i);
      s.roughness = clamped(one - glossiness, 0.0f, 1.0f);
      break;
    }
    case SurfaceModel::unlit:
      s.emissive = s.emissive + base;
      s.base = none;
      return s;
  }
  // What passes is taken from what is diffuse, not from what is mirrored (KHR_materials_transmission); BART's
  // materials state their parts apart.
  if (m.tinted_transmission && m.transmission > 0) {
    const Float16 passing = clamped(number(m.transmission) * channel_of(in.transmission, 0, i), 0.0f, 1.0f);
    s.base = (one - passing) * s.base;
  }
  // A stated ambient reflectance has no texture of its own: it is textured as the base colour is, even where
  // that is black (BART's garden).
  const Vector16 ambient = m.ambient.x < 0 ? s.base : times(broadcast16(m.ambient), pattern);
  s.ambient = times(ambient, broadcast16(ambient_light));
  return s;
}

inline void resolve(const Material& m, const SurfaceInputs& in, const glm::vec3& ambient_light,
                    std::size_t first, std::size_t count, SampleBlock& b) {
  for (std::size_t i = first; i < first + count; i += 16) {
    const Vector16 pattern = times(color_of(in.vertices, i), color_of(in.base, i));
    const Vector16 base = times(broadcast16(m.base_color), pattern);
    const Surfaces s = resolved(m, in, base, pattern, ambient_light, i);
    store3(s.base, b.base, i);
    store3(s.ambient, b.ambient, i);
    store3(s.emissive, b.emissive, i);
    const Float16 alpha = number(m.alpha) * (channel_of(in.vertices, 3, i) * channel_of(in.base, 3, i));
    store(m.alpha_mode == AlphaMode::opaque ? number(1.0f) : alpha, b.alpha + i);
    if (b.keeps_occlusion)
      store(number(1.0f) + number(m.occlusion_strength) * (channel_of(in.occlusion, 0, i) - number(1.0f)),
            b.occlusion + i);
    if (!b.keeps_gloss) continue;
    store3(s.specular, b.specular, i);
    store(s.roughness, b.roughness + i);
    store(s.exponent, b.exponent + i);
    store(s.grazing, b.grazing + i);
  }
}

}  // namespace tenebra::shade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
