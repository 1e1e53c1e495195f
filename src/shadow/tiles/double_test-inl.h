// Points of a tile against one triangle in double, sixteen at a time: what floats leave open, as in light
// that grazes a floor, where that is nearly every pair. Included once per target.
#if defined(TENEBRA_DOUBLE_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_DOUBLE_TEST_INL_H_
#undef TENEBRA_DOUBLE_TEST_INL_H_
#else
#define TENEBRA_DOUBLE_TEST_INL_H_
#endif

#include <cmath>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "shadow/tiles/descent.h"
#include "shadow/tiles/ray_test-inl.h"
#include "simd/double8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// A plane through `a`, not scaled to unit length, and what the products behind its normal are at most.
/// Product by product: where the light is a hair above a floor all that counts may be products of heights,
/// beside lengths that are larger by far.
struct ProductPlane {
  glm::dvec3 a, normal, size;
};

/// Through `a`, with the normal u x v turned to `side`.
inline ProductPlane product_plane(const glm::dvec3& a, const glm::dvec3& u, const glm::dvec3& v,
                                  double side) {
  const glm::dvec3 from(u.y * v.z, u.z * v.x, u.x * v.y), by(u.z * v.y, u.x * v.z, u.y * v.x);
  return {a, side * (from - by), glm::abs(from) + glm::abs(by)};
}

/// normal.(p - a) and how far it is off. The bound of math::edge_side and plane_excess: coordinates of u, v
/// and p - a are off by v = 2^-53 of themselves, a product of three of them carries five roundings, the
/// difference one and the sum two: 8v of the sum of products; there are 16v, and what underflow may take.
/// Fused products round less.
struct ProductValue {
  Double8 value, off;
};
SIMD_INLINE ProductValue value_of(const ProductPlane& plane, const Vector8& p) {
  const Vector8 from = p - broadcast8(plane.a), size{abs(from.x), abs(from.y), abs(from.z)};
  return {dot(broadcast8(plane.normal), from),
          mul_add(broadcast8(0x1p-49), dot(broadcast8(plane.size), size), broadcast8(0x1p-1000))};
}

/// A triangle as the light sees it.
struct ProductTriangle {
  ProductPlane edges[3], own;
  double least, most;  ///< of the contact rule's threshold, for the points of the tile
};

/// `rays_tau`: the largest rounding tolerance of the triangles that the points lie on. The threshold is (tau
/// + the point's) |n| by the operations of contact_threshold(), each rounded by v: the bounds are wider.
inline ProductTriangle product_triangle(const points::Corners& c, int side, const RaySource& source,
                                        ContactRule contact, float rays_tau) {
  const glm::dvec3 light(source.light), v[3] = {c.v[0], c.v[1], c.v[2]};
  ProductTriangle t;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 edge = v[(k + 1) % 3] - v[k];
    t.edges[k] = source.directional ? product_plane(v[k], edge, light, side)
                                    : product_plane(v[k], v[k] - light, edge, side);
  }
  t.own = product_plane(v[0], v[1] - v[0], v[2] - v[0], side);
  const bool use_tau = contact == ContactRule::triangle_ids;
  const double tau = points::rounding_tolerance(c.v), length = glm::length(t.own.normal);
  t.least = use_tau ? tau * length * (1 - 0x1p-40) : 0;
  t.most = use_tau ? (tau + static_cast<double>(rays_tau)) * length * (1 + 0x1p-40) : 0;
  return t;
}

/// As rough_verdict. Edges are closed and the own plane is open, but what is near one is left to the exact
/// stage.
SIMD_INLINE TileVerdict double_verdict(const ProductTriangle& t, const TilePositions& at) {
  TileVerdict verdict{0, 0};
  for (int first = 0; first < 16; first += 8) {
    const Vector8 p{load<Double8>(at.x + first), load<Double8>(at.y + first), load<Double8>(at.z + first)};
    const ProductValue own = value_of(t.own, p);
    const Double8 zero = broadcast8(0.0), least = broadcast8(t.least), most = broadcast8(t.most),
                  own_off = mul_add(broadcast8(0x1p-49), most, own.off);
    Mask<double, 8> missed = lt(own.value + own_off, least), sure = lt(most + own_off, own.value);
    for (const ProductPlane& edge : t.edges) {
      const ProductValue e = value_of(edge, p);
      missed = missed | lt(e.value, zero - e.off);
      sure = sure & lt(e.off, e.value);
    }
    verdict.near |= (0xffu & ~bits(missed)) << first;
    verdict.sure |= bits(sure) << first;
  }
  return verdict;
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
