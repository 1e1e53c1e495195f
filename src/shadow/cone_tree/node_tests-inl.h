// Cone/triangle tests, four sibling nodes at a time, in float. Conservative: a triangle is rejected only if
// no ray of the node can be blocked by it, accepted early only if it blocks all of them. u = 2^-24 below; the
// widenings are derived for planes rounded to float (1u), axes of length 1 +- 2u, with or without FMA. A
// plane with the unit normal m misses the cone if m.w < -sine, and has all of it inside if m.w > sine. Olsson
// and Assarsson 2011, sections 3.2 and 3.3. Included once per target.
#if defined(TENEBRA_SHADOW_NODE_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SHADOW_NODE_TESTS_INL_H_
#undef TENEBRA_SHADOW_NODE_TESTS_INL_H_
#else
#define TENEBRA_SHADOW_NODE_TESTS_INL_H_
#endif

#include "shadow/cone_tree/cone_tree.h"
#include "shadow/decision/triangle_planes.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

using Vector4 = Pack3<Float4>;

constexpr float u = 0x1p-24f;
constexpr float tiny = 1e-36f;  // products below the normal range

struct Nodes {
  Vector4 w;
  Float4 c, near, far, sine, slope;
  std::uint32_t empty;   // bits of lanes without rays
  std::uint32_t narrow;  // bits of lanes below narrow_chord
};

SIMD_INLINE Nodes load_nodes(const NodeBlock& b) {
  Nodes n{{load<Float4>(b.wx), load<Float4>(b.wy), load<Float4>(b.wz)},
          load<Float4>(b.c),
          load<Float4>(b.near),
          load<Float4>(b.far),
          load<Float4>(b.sine),
          load<Float4>(b.slope),
          0,
          0};
  n.empty = lt_bits(n.c, broadcast<Float4>(0.0f));
  n.narrow = lt_bits(n.c, broadcast<Float4>(narrow_chord));
  return n;
}

struct NodeVerdict {
  std::uint32_t rejected;
  std::uint32_t covered;
};

// --- Point lights: cones with the apex at the light -------------------------------------------------------

// Section 3.2, figure 4: a plane through the apex that touches the cone, with its normal towards corner k. If
// all corners lie beyond it, no ray of the cone meets the triangle. n = t - s |t| w with t = the part of the
// corner across w. For every ray d of the cone n.d <= |t.w| + |t| sine - s |t| cosine <= 0 by the choice of
// the slope s.
SIMD_INLINE Mask4 beyond_separating_plane(const TriangleBounds& t, const Nodes& n) {
  const Float4 least_length = broadcast<Float4>(64 * u);
  Vector4 corner[3];
  Float4 along[3];
  for (int k = 0; k < 3; ++k) {
    corner[k] = broadcast3<Float4>(t.cx[k], t.cy[k], t.cz[k]);
    along[k] = dot(corner[k], n.w);
  }
  Mask4 beyond = lt(n.c, n.c);
  for (int k = 0; k < 3; ++k) {
    Vector4 across = subtract_scaled(corner[k], along[k], n.w);
    across = subtract_scaled(across, dot(across, n.w), n.w);
    const Float4 length = sqrt(dot(across, across));
    const Float4 climb = n.slope * length;
    Float4 nearest = dot(across, corner[0]) - climb * along[0];
    nearest = min(nearest, dot(across, corner[1]) - climb * along[1]);
    nearest = min(nearest, dot(across, corner[2]) - climb * along[2]);
    const Float4 margin = broadcast<Float4>(16 * u) * (length + climb);
    beyond = beyond | (lt(margin, nearest) & lt(least_length, length));
  }
  return beyond & lt(n.c, broadcast<Float4>(narrow_chord));
}

// Section 3.2, last paragraph: cones near 90 degrees, which are widened to 90, and wider ones. If all corners
// lie in the complementary cone, which is convex, the triangle does too. Outside of the cone chords to the
// axis are longer than c.
SIMD_INLINE std::uint32_t in_complementary_cone(const TriangleBounds& t, const Nodes& n) {
  const std::uint32_t wide = 15u & ~n.narrow;
  if (wide == 0) return 0;
  const Float4 c = max(n.c, broadcast<Float4>(hemisphere_chord)) + broadcast<Float4>(8 * u);
  const Float4 c2 = c * c * broadcast<Float4>(1 + 8 * u);
  std::uint32_t outside = wide;
  for (int k = 0; k < 3; ++k) {
    const Vector4 apart{broadcast<Float4>(t.cx[k]) - n.w.x, broadcast<Float4>(t.cy[k]) - n.w.y,
                        broadcast<Float4>(t.cz[k]) - n.w.z};
    outside &= lt_bits(c2, dot(apart, apart));
  }
  return outside;
}

SIMD_INLINE NodeVerdict precise_cone_test(const TriangleBounds& t, const Nodes& n, float tau,
                                          bool early_accept) {
  const Float4 slack = broadcast<Float4>(5.2f * u + t.rho);
  Float4 lowest = broadcast<Float4>(4.0f);
  for (int k = 0; k < 3; ++k) lowest = min(lowest, dot(broadcast3<Float4>(t.mx[k], t.my[k], t.mz[k]), n.w));
  Mask4 rejected = lt(lowest + n.sine + slack, broadcast<Float4>(0.0f));

  // Nearest and farthest crossing of the own plane: rays reach it where |p| m.d > d.
  const Float4 plane_slack = broadcast<Float4>(5.2f * u + t.rho);
  const Float4 facing = dot(broadcast3<Float4>(t.mx[3], t.my[3], t.mz[3]), n.w);
  const Float4 reach =
      n.far * (facing + n.c + plane_slack) * broadcast<Float4>(1 + 4 * u) + broadcast<Float4>(tiny);
  rejected = rejected | lt(reach, broadcast<Float4>(t.d[3] * (1 - 4 * u)));
  // The plane may come nearer to the light than the triangle does. This test is not in the paper; it rejects
  // a fifth to a half of the nodes of wide unsorted cones.
  rejected = rejected | lt(n.far, broadcast<Float4>(t.sphere_near));
  NodeVerdict v{n.empty | bits(rejected), 0};
  if (v.rejected == 15) return v;

  v.rejected |= bits(beyond_separating_plane(t, n)) | in_complementary_cone(t, n);
  if (early_accept) {
    const Float4 least =
        n.near * (facing - n.c - plane_slack) * broadcast<Float4>(1 - 4 * u) - broadcast<Float4>(tiny);
    v.covered =
        bits(lt(n.sine + slack, lowest) & lt(broadcast<Float4>((t.d[3] + tau) * (1 + 8 * u) + tiny), least)) &
        ~v.rejected;
  }
  return v;
}

// The earlier work: the triangle's bounding sphere. Its cap of directions has the chord sphere_chord, so a
// common direction needs |w - s| <= c + chord.
SIMD_INLINE NodeVerdict sphere_cone_test(const TriangleBounds& t, const Nodes& n) {
  const Vector4 apart{broadcast<Float4>(t.sx) - n.w.x, broadcast<Float4>(t.sy) - n.w.y,
                      broadcast<Float4>(t.sz) - n.w.z};
  const Float4 sum = n.c + broadcast<Float4>(t.sphere_chord + 8 * u);
  // A light inside the sphere sees it in all directions: no node is rejected by them.
  const Float4 limit = sum * sum * broadcast<Float4>(t.sphere_chord < 2.0f ? 1 + 16 * u : 1e9f);
  return {n.empty | bits(lt(limit, dot(apart, apart)) | lt(n.far, broadcast<Float4>(t.sphere_near))), 0};
}

// --- Directional lights: cylinders along the light --------------------------------------------------------

SIMD_INLINE Float4 plane_value(const TriangleBounds& t, int k, const Nodes& n) {
  return dot(broadcast3<Float4>(t.mx[k], t.my[k], t.mz[k]), n.w) - broadcast<Float4>(t.d[k]);
}

// The size of coordinates at the cylinder; every rounding is relative to it.
SIMD_INLINE Float4 cylinder_scale(const TriangleBounds& t, const Nodes& n) {
  const Float4 zero = broadcast<Float4>(0.0f);
  const auto magnitude = [&](Float4 a) HWY_ATTR { return zero - min(a, zero - a); };
  Float4 scale = magnitude(n.w.x) + magnitude(n.w.y) + magnitude(n.w.z) + n.c;
  scale = scale + magnitude(n.near) + magnitude(n.far);
  float d = 0;
  for (int k = 0; k < 4; ++k) d = HWY_MAX(d, HWY_MAX(t.d[k], -t.d[k]));
  return scale + broadcast<Float4>(d);
}

SIMD_INLINE std::uint32_t beyond_separating_line(const TriangleBounds& t, const Nodes& n, Float4 slack) {
  std::uint32_t beyond = 0;
  Vector4 apart[3];
  for (int k = 0; k < 3; ++k) {
    apart[k] = {broadcast<Float4>(t.cx[k]) - n.w.x, broadcast<Float4>(t.cy[k]) - n.w.y,
                broadcast<Float4>(t.cz[k]) - n.w.z};
  }
  for (int k = 0; k < 3; ++k) {
    const Float4 length2 = dot(apart[k], apart[k]);
    const Float4 inverse = broadcast<Float4>(1.0f) / sqrt(length2);
    Float4 nearest = dot(apart[k], apart[0]);
    nearest = min(nearest, dot(apart[k], apart[1]));
    nearest = min(nearest, dot(apart[k], apart[2]));
    beyond |= lt_bits(n.c + slack + slack, nearest * inverse) & lt_bits(broadcast<Float4>(1e-28f), length2);
  }
  return beyond;
}

SIMD_INLINE NodeVerdict precise_cylinder_test(const TriangleBounds& t, const Nodes& n, float tau,
                                              bool early_accept) {
  const Float4 scale = cylinder_scale(t, n);
  const Float4 slack = scale * broadcast<Float4>(10 * u + t.rho) + broadcast<Float4>(tiny);
  Float4 lowest = min(plane_value(t, 0, n), min(plane_value(t, 1, n), plane_value(t, 2, n)));
  NodeVerdict v{n.empty, 0};
  v.rejected |= lt_bits(lowest + n.c + slack, broadcast<Float4>(0.0f));

  const Float4 plane_slack = scale * broadcast<Float4>(10 * u + t.rho) + broadcast<Float4>(tiny);
  const Float4 level = plane_value(t, 3, n), climb = broadcast<Float4>(t.climb);
  v.rejected |= lt_bits(level + n.c + n.far * climb + plane_slack, broadcast<Float4>(0.0f));
  v.rejected |= lt_bits(n.far, broadcast<Float4>(t.sphere_near) - slack);
  if (v.rejected == 15) return v;

  v.rejected |= beyond_separating_line(t, n, slack);
  if (early_accept) {
    const Float4 least = level - n.c + n.near * climb - plane_slack;
    v.covered = lt_bits(n.c + slack, lowest) & lt_bits(broadcast<Float4>(tau * (1 + 8 * u) + tiny), least) &
                ~v.rejected;
  }
  return v;
}

SIMD_INLINE NodeVerdict sphere_cylinder_test(const TriangleBounds& t, const Nodes& n) {
  const Vector4 apart{broadcast<Float4>(t.sx) - n.w.x, broadcast<Float4>(t.sy) - n.w.y,
                      broadcast<Float4>(t.sz) - n.w.z};
  const Float4 slack = cylinder_scale(t, n) * broadcast<Float4>(10 * u) + broadcast<Float4>(tiny);
  const Float4 sum = n.c + broadcast<Float4>(t.sphere_chord) + slack;
  const Float4 length2 = dot(apart, apart);
  NodeVerdict v{n.empty, 0};
  v.rejected |= lt_bits(sum * sum * broadcast<Float4>(1 + 16 * u), length2) &
                lt_bits(broadcast<Float4>(1e-28f), length2);
  v.rejected |= lt_bits(n.far, broadcast<Float4>(t.sphere_near) - slack);
  return v;
}

// --- One entry --------------------------------------------------------------------------------------------

/// Bits of the four nodes that triangle `t` misses for sure, and of those it covers for sure (early_accept
/// only). `tau`: largest rounding tolerance of the rays' own triangles.
SIMD_INLINE NodeVerdict test_nodes(const TriangleBounds& t, const Nodes& n, bool spheres, bool directional,
                                   float tau, bool early_accept) {
  if (directional)
    return spheres ? sphere_cylinder_test(t, n) : precise_cylinder_test(t, n, tau, early_accept);
  return spheres ? sphere_cone_test(t, n) : precise_cone_test(t, n, tau, early_accept);
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
