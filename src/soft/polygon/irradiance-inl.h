// Irradiance from polygons of uniform, diffuse light, and their area: one sum over edges. Included once per
// target.
#if defined(TENEBRA_SOFT_IRRADIANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_IRRADIANCE_INL_H_
#undef TENEBRA_SOFT_IRRADIANCE_INL_H_
#else
#define TENEBRA_SOFT_IRRADIANCE_INL_H_
#endif

#include <vector>

#include "simd/double8-inl.h"
#include "soft/light/light_frame.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Edges of polygons on the light's plane, from (u0, v0) to (u1, v1).
struct LightEdges {
  std::vector<double> u0, v0, u1, v1;
  std::size_t count = 0;

  /// Makes room for `more` edges and a full register behind them.
  void reserve(std::size_t more) {
    const std::size_t needed = count + more + 16;
    if (u0.size() >= needed) return;
    for (auto* values : {&u0, &v0, &u1, &v1}) values->resize(2 * needed);
  }
};

/// atan2(s, c) / s for s > 0, in one division; relative error below 1e-13. 0 where s times the larger of s
/// and |c| is below about 1e-290.
SIMD_INLINE Double8 angle_over_sine(Double8 s, Double8 c) {
  const Double8 size = abs(c);
  const Double8 low = min(s, size), high = max(s, size);
  // atan(low / high), beyond pi/8 by atan(q) = pi/4 + atan((q - 1) / (q + 1)).
  const auto steep = lt(broadcast8(0.41421356237309503) * high, low);
  const Double8 below = select(steep, low + high, high);
  const auto none = lt(below * s, broadcast8(1e-290));
  const Double8 share = broadcast8(1.0) / select(none, broadcast8(1.0), below * s);
  const Double8 q = select(steep, low - high, low) * (s * share);
  const Double8 y = q * q;
  // Chebyshev interpolation of atan(q) / q in y, 0 <= y <= tan(pi/8)^2.
  Double8 p = broadcast8(0.030662440370424447);
  for (const double a :
       {-0.05874505621307831, 0.07563703551915192, -0.09078392072943424, 0.11110385046148014,
        -0.14285690423839287, 0.19999999604891977, -0.33333333330803444, 0.9999999999999732}) {
    p = p * y + broadcast8(a);
  }
  Double8 angle = q * p;
  angle = select(steep, broadcast8(0.7853981633974483) + angle, angle);
  angle = select(lt(size, s), broadcast8(1.5707963267948966) - angle, angle);
  angle = select(lt(c, broadcast8(0.0)), broadcast8(3.141592653589793) - angle, angle);
  return select(none, broadcast8(0.0), angle * (below * share));
}

/// The angle that an edge `e` from `r` on subtends, times the cosine between `normal` and the normal of the
/// plane through point and edge (Nishita and Nakamae 1985); 0 for an edge of no length, or seen end-on.
SIMD_INLINE Double8 contour_term(const Pack3<Double8>& r, const Pack3<Double8>& e,
                                 const Pack3<Double8>& normal) {
  const Pack3<Double8> c = cross(r, e);
  const Double8 sine = sqrt(dot_unfused(c, c)), cosine = dot_unfused(r, r) + dot_unfused(r, e);
  return dot_unfused(normal, c) * angle_over_sine(sine, cosine);
}

/// origin + u ex + v ey.
SIMD_INLINE Pack3<Double8> on_light(const LightFrame& light, const Pack3<Double8>& origin, Double8 u,
                                    Double8 v) {
  return {origin.x + u * broadcast8(light.ex.x) + v * broadcast8(light.ey.x),
          origin.y + u * broadcast8(light.ex.y) + v * broadcast8(light.ey.y),
          origin.z + u * broadcast8(light.ex.z) + v * broadcast8(light.ey.z)};
}

/// A point as the light is seen from it: world space, metres.
struct Receiver3 {
  glm::dvec3 to_origin{0.0};  ///< from the point to the light's origin
  glm::dvec3 normal{0.0};     ///< unit
};

struct EdgeSums {
  double area = 0;        ///< units of the light squared
  double irradiance = 0;  ///< for radiance 1
};

/// Area and irradiance of the polygons with these edges, counter-clockwise seen from the light's front; edges
/// that two polygons share cancel. Irradiance in Nishita and Nakamae's contour form (1985): -1/2 the sum over
/// the edges of the angle that an edge subtends times the cosine between the receiver's normal and the normal
/// of the plane through point and edge. Expects polygons above the receiver's horizon, and a point that is
/// not on the light's plane. The same bits on every target: each lane sums every eighth edge, and the lanes
/// are added in a fixed order.
inline HWY_NOINLINE EdgeSums sum_edges(const LightEdges& edges, const LightFrame& light,
                                       const Receiver3& at) {
  const Pack3<Double8> origin = broadcast8(at.to_origin), normal = broadcast8(at.normal);
  const Double8 zero = broadcast<Double8>(0.0);
  Double8 irradiance = zero, area = zero;
  for (std::size_t k = 0; k < edges.count; k += 8) {
    const Double8 u0 = load<Double8>(&edges.u0[k]), v0 = load<Double8>(&edges.v0[k]);
    const Double8 u1 = load<Double8>(&edges.u1[k]), v1 = load<Double8>(&edges.v1[k]);
    const Double8 term = contour_term(on_light(light, origin, u0, v0),
                                      on_light(light, {zero, zero, zero}, u1 - u0, v1 - v0), normal);
    const auto there = mask_of_bits<double, 8>(edges.count - k < 8 ? (1u << (edges.count - k)) - 1u : 0xffu);
    irradiance = irradiance - select(there, term, zero);
    area = area + select(there, u0 * v1 - u1 * v0, zero);
  }
  return {reduce_add_in_order(area) * 0.5, reduce_add_in_order(irradiance) * 0.5};
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
