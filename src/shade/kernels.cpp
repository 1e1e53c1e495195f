#include "shade/kernels.h"

#include <bit>
#include <cstring>

static_assert(std::endian::native == std::endian::little);

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "shade/bend-inl.h"
#include "shade/display-inl.h"
#include "shade/gloss-inl.h"
#include "shade/panorama-inl.h"
#include "shade/resolve-inl.h"
#include "simd/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shade::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using Int16 = Pack<std::int32_t, 16>;

Float16 at(const Plane& plane, Float16 dx, Float16 dy) {
  return broadcast<Float16>(plane.value) + broadcast<Float16>(plane.dx) * dx +
         broadcast<Float16>(plane.dy) * dy;
}

/// Weights of the second and third vertex: where the ray meets the plane, moved into the triangle.
struct Weights {
  Float16 u, v, depth;
};
Weights weights_of(const TriangleSetup& setup, Float16 x, Float16 y) {
  const Float16 third = broadcast<Float16>(1.0f / 3.0f), zero = broadcast<Float16>(0.0f),
                one = broadcast<Float16>(1.0f);
  if (setup.flat) return {third, third, zero};
  const Float16 dx = x - broadcast<Float16>(setup.origin.x), dy = y - broadcast<Float16>(setup.origin.y);
  Weights w{at(setup.u, dx, dy), at(setup.v, dx, dy), one};
  Mask<float, 16> inside = le(zero, one);
  if (setup.in_perspective) {
    const Float16 depth = at(setup.depth, dx, dy);
    inside = lt(zero, depth);
    w.depth = one / depth;
    w.u = w.u * w.depth;
    w.v = w.v * w.depth;
  }
  const Float16 rest = one - w.u - w.v;
  const Mask<float, 16> in_front = inside;
  inside = inside & le(zero, w.u) & le(zero, w.v) & le(zero, rest);
  if (bits(inside) == 0xffff) return w;
  const Float16 u = max(w.u, zero), v = max(w.v, zero), sum = u + v + max(rest, zero);
  const Mask<float, 16> usable = in_front & lt(zero, sum) & lt(sum, broadcast<Float16>(1e30f));
  w.u = select(inside, w.u, select(usable, u / sum, third));
  w.v = select(inside, w.v, select(usable, v / sum, third));
  w.depth = select(in_front & lt(w.depth, broadcast<Float16>(1e30f)), w.depth, zero);
  return w;
}

Vector16 normal_at(const TriangleSetup& setup, const Weights& w) {
  const Vector16 face = broadcast16(setup.face);
  const Vector16 n =
      broadcast16(setup.normal) + w.u * broadcast16(setup.to_second) + w.v * broadcast16(setup.to_third);
  const Float16 size = abs(n.x) + abs(n.y) + abs(n.z);
  const Float16 length = sqrt(dot_unfused(n, n));
  const Float16 towards = dot_unfused(n, face);
  const Float16 scale = broadcast<Float16>(1.0f) / select(lt(towards, broadcast<Float16>(0.0f)),
                                                          broadcast<Float16>(0.0f) - length, length);
  return select3(lt(broadcast<Float16>(1e-6f), size), scale * n, face);
}

void place(const TriangleSetup& setup, bool smooth_terminator, const float* x, const float* y,
           std::size_t first, std::size_t count, SampleBlock& b) {
  const bool by_normal = smooth_terminator && setup.rounded;
  for (std::size_t i = first; i < first + count; i += 16) {
    const Weights w = weights_of(setup, load<Float16>(x + i), load<Float16>(y + i));
    store(w.u, b.u + i);
    store(w.v, b.v + i);
    store(w.depth, b.depth + i);
    store3(broadcast16(setup.a) + w.u * broadcast16(setup.e1) + w.v * broadcast16(setup.e2), b.point, i);
    const Vector16 normal = setup.smooth ? normal_at(setup, w) : broadcast16(setup.normal);
    store3(by_normal ? normal : broadcast16(setup.face), b.before, i);
    store3(normal, b.normal, i);
    if (b.keeps_unbent) store3(normal, b.unbent, i);
  }
}

void cover(const Surface& surface, std::size_t first, std::size_t count, SampleBlock& b) {
  for (std::size_t i = first; i < first + count; i += 16) {
    store3(broadcast16(surface.base), b.base, i);
    store3(broadcast16(surface.ambient), b.ambient, i);
    store3(broadcast16(surface.emissive), b.emissive, i);
    store(broadcast<Float16>(surface.alpha), b.alpha + i);
    if (b.keeps_occlusion) store(broadcast<Float16>(1.0f), b.occlusion + i);
    if (!b.keeps_gloss) continue;
    store3(broadcast16(surface.specular), b.specular, i);
    store(broadcast<Float16>(surface.roughness), b.roughness + i);
    store(broadcast<Float16>(surface.exponent), b.exponent + i);
    store(broadcast<Float16>(surface.grazing), b.grazing + i);
  }
}

void look(const glm::vec3* towards, SampleBlock& b) {
  for (std::size_t i = 0; i < b.count; i += 16) {
    const Vector16 point = load3(b.point, i);
    store3(towards != nullptr ? broadcast16(*towards) : unit(broadcast16(glm::vec3(0.0f)) - point), b.to_eye,
           i);
  }
}

void reflect(const glm::vec3& around, const glm::vec3& brighter, SampleBlock& b) {
  for (std::size_t i = 0; i < b.count; i += 16) {
    const Float16 smooth = number(1.0f) - load<Float16>(b.roughness + i);
    store3(broadcast16(around) + smooth * broadcast16(brighter), b.reflected, i);
  }
}

void see(const Panorama& picture, const SampleBlock::Channel (&towards)[3], const float* roughness,
         std::size_t first, std::size_t count, SampleBlock::Channel (&out)[3]) {
  for (std::size_t i = first; i < first + count; i += 16) {
    const Float16 rough = roughness == nullptr ? number(0.0f) : load<Float16>(roughness + i);
    store3(seen(picture, load3(towards, i), max(rough, number(0.0f))), out, i);
  }
}

void surround(const Panorama& irradiance, const Panorama& radiance, SampleBlock& b) {
  for (std::size_t i = 0; i < b.count; i += 16) {
    const Vector16 normal = load3(b.normal, i), ambient = load3(b.ambient, i);
    const Mask<float, 16> faces = lt(number(0.0f), abs(normal.x) + abs(normal.y) + abs(normal.z));
    store3(select3(faces, times(ambient, seen(irradiance, normal, number(0.0f))), ambient), b.ambient, i);
    if (!b.glossy) continue;
    const Gloss g = gloss_of(b, i);
    if (any(g.ggx)) store3(seen(radiance, mirrored(g), g.roughness), b.reflected, i);
  }
}

void begin(const float* openness, SampleBlock& b) {
  for (std::size_t i = 0; i < b.count; i += 16) {
    Vector16 ambient = b.glossy ? glossy_ambient(b, i) : load3(b.ambient, i);
    if (b.keeps_occlusion) ambient = load<Float16>(b.occlusion + i) * ambient;
    if (openness != nullptr) ambient = load<Float16>(openness + i) * ambient;
    store3(ambient + load3(b.emissive, i), b.color, i);
  }
}

void light(const LightTerms& terms, const float* factor, SampleBlock& b) {
  for (std::size_t i = 0; i < b.count; i += 16) {
    const Incident incident = incident_light(terms, b, i);
    Vector16 shown = b.glossy ? glossy_light(terms, incident, b, i) : diffuse_light(terms, incident, b, i);
    if (factor != nullptr) shown = load<Float16>(factor + i) * shown;
    store3(load3(b.color, i) + shown, b.color, i);
  }
}

void show(const Display& display, SampleBlock& b) {
  for (std::size_t i = 0; i < b.count; i += 16) store3(shown(display, load3(b.color, i)), b.color, i);
}

/// Levels of sixteen values from 0 to 1.
Int16 levels(const LevelTable& table, Float16 value) {
  const Int16 bucket = shift_right<LevelTable::shift>(bits_of(value)) - broadcast<Int16>(table.first);
  const Int16 place = shift_left<2>(max(bucket, broadcast<Int16>(0)));
  const Float16 threshold = gather<float>(table.threshold.data(), place);
  const Int16 level = gather<std::int32_t>(table.level.data(), place);
  return select(le(threshold, value), level + broadcast<Int16>(1), level);
}

void encode_block(const LevelTable& table, const Display& display, const SampleBlock& b, std::uint8_t* rgb) {
  for (std::size_t i = 0; i < b.count; i += 16) {
    const Vector16 color = shown(display, load3(b.color, i));
    std::int32_t level[16];
    store(levels(table, color.x) | shift_left<8>(levels(table, color.y)) |
              shift_left<16>(levels(table, color.z)),
          level);
    const std::size_t count = b.count - i < 16 ? b.count - i : 16;
    for (std::size_t k = 0; k < count; ++k) {
      // Four bytes at once: the fourth is the first of the next sample, which overwrites it; the last sample
      // has no next.
      if (i + k + 1 < b.count) {
        std::memcpy(rgb + 3 * (i + k), &level[k], 4);
      } else {
        std::memcpy(rgb + 3 * (i + k), &level[k], 3);
      }
    }
  }
}

}  // namespace

Kernels kernels() {
  return {place,   cover, locate,   blend, resolve, bend, nullptr,     look,
          reflect, see,   surround, begin, light,   show, encode_block};
}

}  // namespace tenebra::shade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::shade {

Kernels kernels(SimdLevel level) {
  Kernels found = TENEBRA_DISPATCH(level, kernels)();
  found.sample = texture::sampler(level);
  return found;
}

}  // namespace tenebra::shade
#endif
