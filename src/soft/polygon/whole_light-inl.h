// Points that see the whole light, eight at a time. Included once per target.
#if defined(TENEBRA_SOFT_WHOLE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_WHOLE_LIGHT_INL_H_
#undef TENEBRA_SOFT_WHOLE_LIGHT_INL_H_
#else
#define TENEBRA_SOFT_WHOLE_LIGHT_INL_H_
#endif

#include "soft/polygon/irradiance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Where the planes across shading normals through points meet the light's plane: a line in each lane,
/// positive above.
struct HorizonLanes {
  Double8 u, v, w;

  /// Bits of the lanes where a part of the light is not above.
  SIMD_INLINE std::uint32_t cuts(const LightFrame& light) const {
    const Double8 zero = broadcast<Double8>(0.0);
    auto above = lt(zero, broadcast<Double8>(1.0));
    for (const glm::dvec2& at : light.polygon)
      above = above & lt(zero, u * broadcast<Double8>(at.x) + v * broadcast<Double8>(at.y) + w);
    return ~bits(above) & 0xffu;
  }
};
SIMD_INLINE HorizonLanes horizon_of(const LightFrame& light, const Pack3<Double8>& to_origin,
                                    const Pack3<Double8>& normal) {
  return {dot_unfused(normal, broadcast8(light.ex)), dot_unfused(normal, broadcast8(light.ey)),
          dot_unfused(normal, to_origin)};
}

/// Up to eight points, one in each lane.
struct WholePoints {
  std::size_t count = 0;
  std::uint32_t pixels[8] = {};
  double to_origin[3][8] = {}, normal[3][8] = {};  ///< as in Receiver3

  bool full() const { return count == 8; }
  void add(std::uint32_t pixel, const glm::dvec3& way, const glm::dvec3& n) {
    for (int c = 0; c < 3; ++c) {
      to_origin[c][count] = way[c];
      normal[c][count] = n[c];
    }
    pixels[count++] = pixel;
  }
};

/// The irradiance that the whole light sends to points which see all of it above the planes that they lie on.
/// Returns the bits of the points for which the sum holds: those in front of the light, with all of it above
/// the horizons of their shading normals.
inline HWY_NOINLINE std::uint32_t irradiance_of_whole(const LightFrame& light, const WholePoints& at,
                                                      double* irradiance) {
  const auto lanes = [](const double(&from)[3][8]) {
    return Pack3<Double8>{load<Double8>(from[0]), load<Double8>(from[1]), load<Double8>(from[2])};
  };
  const Pack3<Double8> origin = lanes(at.to_origin), normal = lanes(at.normal);
  Double8 sum = broadcast8(0.0);
  for (std::size_t k = 0; k < light.polygon.size(); ++k) {
    const glm::dvec2 a = light.polygon[k], b = light.polygon[(k + 1) % light.polygon.size()];
    const glm::dvec3 from = a.x * light.ex + a.y * light.ey,
                     along = (b.x - a.x) * light.ex + (b.y - a.y) * light.ey;
    const Pack3<Double8> r{origin.x + broadcast8(from.x), origin.y + broadcast8(from.y),
                           origin.z + broadcast8(from.z)};
    const Pack3<Double8> e{broadcast8(along.x), broadcast8(along.y), broadcast8(along.z)};
    sum = sum - contour_term(r, e, normal);
  }
  store(broadcast8(0.5) * sum, irradiance);
  const glm::dvec3& n = light.normal;
  const std::uint32_t in_front = lt_bits(dot_unfused(origin, broadcast8(n)), broadcast8(0.0));
  return in_front & ~horizon_of(light, origin, normal).cuts(light) & ((1u << at.count) - 1u);
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
