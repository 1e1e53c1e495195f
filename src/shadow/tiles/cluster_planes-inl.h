// Planes of a cluster's sixteen triangles through the light, in double. The same quantities and error bounds
// as planes_of: A x (B - A) has an error of 4 sqrt(3) v |a||e|; with the normalisation and the evaluation it
// stays below rho (|p| + reach), rho = 2^-48 |a||e| / |m| (v = 2^-53). Of distant lights (RaySource::distant)
// as well: there a is the corner relative to the light, or the light's direction, and d = m.a that of the
// corner relative to the origin. Included once per target.
#if defined(TENEBRA_CLUSTER_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_CLUSTER_PLANES_INL_H_
#undef TENEBRA_CLUSTER_PLANES_INL_H_
#else
#define TENEBRA_CLUSTER_PLANES_INL_H_
#endif

#include <cmath>

#include "points/contact_rule.h"
#include "shadow/tiles/descent.h"
#include "simd/double8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Eight triangles in double.
struct Eight {
  Vector8 p[3];     // corners, world space
  Vector8 a[3];     // relative to the source's origin
  Double8 side;     // +1, -1; 0 where double cannot tell
  Double8 largest;  // of the corners' |coordinates| in world space
};

SIMD_INLINE Eight load_eight(const TriangleCluster& c, int at, const glm::dvec3& origin) {
  Eight t;
  t.largest = broadcast<Double8>(0.0);
  for (int k = 0; k < 3; ++k) {
    t.p[k] = {load_widened<Double8>(c.x[k] + at), load_widened<Double8>(c.y[k] + at),
              load_widened<Double8>(c.z[k] + at)};
    t.largest = max(t.largest, max(abs(t.p[k].x), max(abs(t.p[k].y), abs(t.p[k].z))));
    t.a[k] = t.p[k] - broadcast8(origin);
  }
  return t;
}

/// From the light to corner k, or the way that a directional light travels.
SIMD_INLINE Vector8 ray_to(const Eight& t, int k, const RaySource& source) {
  if (source.directional) return broadcast8(-glm::dvec3(source.light));
  return source.distant ? t.p[k] - broadcast8(glm::dvec3(source.light)) : t.a[k];
}

/// Stores plane `k`, turned to the side of `side`; returns the square of rho / 2^-48. A normal of length 0
/// gives a plane of zeros and an infinite error: all is left to the exact stage.
SIMD_INLINE Double8 store_plane(ClusterPlanes& out, int k, int at, const Vector8& m, Double8 side,
                                Double8 squares, Vector8& unit) {
  const Double8 zero = broadcast<Double8>(0.0), length2 = dot(m, m);
  const Mask<double, 8> real = lt(zero, length2);
  const Double8 inverse = select(real, broadcast<Double8>(1.0) / sqrt(length2), zero);
  const Double8 factor = inverse * side;
  unit = {m.x * factor, m.y * factor, m.z * factor};
  store(unit.x, out.mx[k] + at), store(unit.y, out.my[k] + at), store(unit.z, out.mz[k] + at);
  store_narrowed(unit.x, out.fx[k] + at), store_narrowed(unit.y, out.fy[k] + at);
  store_narrowed(unit.z, out.fz[k] + at);
  return select(real, squares * inverse * inverse, broadcast<Double8>(HUGE_VAL));
}

/// Side of the light: sign of n.(A - L) where the error bound of the product allows, else 0.
SIMD_INLINE Double8 certain_side(const Vector8& n, const Vector8& a, Double8 squares) {
  const Double8 value = dot(n, a);
  const Double8 bound2 = broadcast<Double8>(0x1p-92) * squares * dot(a, a);
  const Double8 one = broadcast<Double8>(1.0);
  const Double8 sign = select(lt(broadcast<Double8>(0.0), value), one, broadcast<Double8>(-1.0));
  return select(lt(bound2, value * value), sign, broadcast<Double8>(0.0));
}

/// Exact sides of the lanes in `lanes` whose side is 0; returns the lanes that are really 0.
inline std::uint32_t settle_sides(const TriangleCluster& c, int at, std::uint32_t lanes,
                                  const RaySource& source, double side[8]) {
  std::uint32_t edge_on = 0;
  for (int i = 0; i < 8; ++i) {
    if (!((lanes >> i) & 1u) || side[i] != 0) continue;
    glm::vec3 v[3];
    for (int k = 0; k < 3; ++k) v[k] = {c.x[k][at + i], c.y[k][at + i], c.z[k][at + i]};
    side[i] = light_side(v, source);
    if (side[i] == 0) edge_on |= 1u << i;
  }
  return edge_on;
}

/// Planes of triangles at ... at + 7, whose bits of `valid` and `edge_on` are added.
SIMD_INLINE void set_up_eight(const TriangleCluster& c, int at, const RaySource& source, bool use_tau,
                              bool cull_front, ClusterPlanes& out) {
  Eight t = load_eight(c, at, source.origin);
  const Vector8 e1 = t.p[1] - t.p[0], e2 = t.p[2] - t.p[0], n = cross(e1, e2);
  const Double8 own_squares = dot(e1, e1) * dot(e2, e2);
  t.side = certain_side(n, ray_to(t, 0, source), own_squares);
  std::uint32_t valid = (c.used >> at) & 255u;
  double side[8];
  store(t.side, side);
  const std::uint32_t edge_on = settle_sides(c, at, valid, source, side);
  valid &= ~edge_on;
  if (cull_front) {
    for (int i = 0; i < 8; ++i) valid &= side[i] < 0 ? ~(1u << i) : ~0u;
  }
  t.side = load<Double8>(side);
  out.turned |= bits(lt(t.side, broadcast<Double8>(0.0))) << at;

  Vector8 unit;
  Double8 worst = broadcast<Double8>(0.0), reach2 = worst;
  const Double8 zero = broadcast<Double8>(0.0);
  const bool through_origin = !source.directional && !source.distant;
  for (int k = 0; k < 3; ++k) {
    const Vector8 edge = t.p[(k + 1) % 3] - t.p[k], ray = ray_to(t, k, source);
    const Double8 squares = dot(ray, ray) * dot(edge, edge);
    worst = max(worst, store_plane(out, k, at, cross(ray, edge), t.side, squares, unit));
    const Double8 d = through_origin ? zero : dot(unit, t.a[k]);
    store(d, out.d[k] + at), store_narrowed(d, out.fd[k] + at);
    reach2 = max(reach2, dot(t.a[k], t.a[k]));
  }
  const Double8 own_worst = store_plane(out, 3, at, n, t.side, own_squares, unit);
  const Double8 tau = t.largest * broadcast<Double8>(use_tau ? points::contact_tau : 0.0);
  const Double8 d = dot(unit, t.a[0]) + tau;
  store(d, out.d[3] + at), store_narrowed(d, out.fd[3] + at);
  store_narrowed(tau * broadcast<Double8>(1 + 0x1p-20), out.tau + at);
  const Double8 rho = broadcast<Double8>(0x1p-48 * (1 + 0x1p-20));
  store_narrowed(sqrt(max(worst, own_worst)) * rho, out.rho + at);
  store_narrowed(sqrt(own_worst) * rho, out.own_rho + at);
  store_narrowed(sqrt(reach2) * broadcast<Double8>(1 + 0x1p-20), out.reach + at);
  out.valid |= valid << at;
  out.edge_on |= edge_on << at;
}

SIMD_INLINE void set_up_planes(const TriangleCluster& c, const RaySource& source, bool use_tau,
                               bool cull_front, ClusterPlanes& out) {
  out.valid = out.edge_on = out.turned = 0;
  set_up_eight(c, 0, source, use_tau, cull_front, out);
  set_up_eight(c, 8, source, use_tau, cull_front, out);
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
