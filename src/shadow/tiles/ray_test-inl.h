// Sixteen rays of a tile against one triangle: all in float, which most triangles miss by more than floats
// are off; then planes at the base of the tile's square in double, the rest in float. Included once per
// target.
#if defined(TENEBRA_RAY_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_RAY_TEST_INL_H_
#undef TENEBRA_RAY_TEST_INL_H_
#else
#define TENEBRA_RAY_TEST_INL_H_
#endif

#include <cmath>

#include "shadow/tiles/descent.h"
#include "shadow/tiles/face_tests-inl.h"
#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// The points of a tile relative to the source's origin, in float. The base is rounded, q is, and so is their
/// sum: each coordinate is off by at most 3u (|base| + grain), the point by 3u reach.
struct RoughRays {
  Pack3<Float16> p;
  float reach;  ///< >= |p|, and large enough for the bound above
};

SIMD_INLINE RoughRays rough_rays(const points::PointTile& tile, const points::PointBase& from,
                                 const glm::dvec3& origin) {
  float base[3];
  for (int k = 0; k < 3; ++k) base[k] = static_cast<float>(static_cast<double>(from.at[k]) - origin[k]);
  return {{broadcast<Float16>(base[0]) + load<Float16>(tile.qx),
           broadcast<Float16>(base[1]) + load<Float16>(tile.qy),
           broadcast<Float16>(base[2]) + load<Float16>(tile.qz)},
          std::abs(base[0]) + std::abs(base[1]) + std::abs(base[2]) + 2 * from.grain};
}

/// Lanes of a tile.
struct TileVerdict {
  std::uint32_t near;  ///< not certainly missed
  std::uint32_t sure;  ///< certainly blocked, of those that are near
};

/// Triangle i of a cluster. The points are off by 3u reach, the planes by u, products and sums by 5u of |p|
/// (without fused ones), d by u and its difference by u more: below 12u (|p| + |d|), where |d| exceeds the
/// triangle's reach by its tau only; if that is more than 5 (|p| + reach), the own plane is missed by far.
/// Behind the own plane a point must lie farther by tau of the rays' own triangles. `anchored`: edges have a
/// d, too.
template <bool anchored>
SIMD_INLINE TileVerdict rough_verdict(const ClusterPlanes& c, int i, const RoughRays& rays, float tau) {
  const auto product = [&](int k) HWY_ATTR {
    return mul_add(
        broadcast<Float16>(c.fz[k][i]), rays.p.z,
        mul_add(broadcast<Float16>(c.fy[k][i]), rays.p.y, broadcast<Float16>(c.fx[k][i]) * rays.p.x));
  };
  const auto value = [&](int k) HWY_ATTR {
    if constexpr (anchored) return product(k) - broadcast<Float16>(c.fd[k][i]);
    return product(k);
  };
  const Float16 edges = min(value(0), min(value(1), value(2))),
                own = product(3) - broadcast<Float16>(c.fd[3][i]);
  const float k = (12 * u + c.rho[i]) * (1 + 8 * u) * (rays.reach + c.reach[i]) + 2.5f * u * tau + 0x1p-122f;
  return {0xffffu & ~lt_bits(min(edges, own), broadcast<Float16>(-k)),
          lt_bits(broadcast<Float16>(k), min(edges, own - broadcast<Float16>(tau)))};
}

/// One of a cluster's triangles, its four planes side by side.
struct LeafTriangle {
  double mx[4], my[4], mz[4], d[4];
  float fx[4], fy[4], fz[4];
  float rho, own_rho, reach;
};

SIMD_INLINE void take_triangle(const ClusterPlanes& c, int i, LeafTriangle& t) {
  for (int k = 0; k < 4; ++k) {
    t.mx[k] = c.mx[k][i], t.my[k] = c.my[k][i], t.mz[k] = c.mz[k][i];
    t.d[k] = c.d[k][i];
    t.fx[k] = c.fx[k][i], t.fy[k] = c.fy[k][i], t.fz[k] = c.fz[k][i];
  }
  t.rho = c.rho[i], t.own_rho = c.own_rho[i], t.reach = c.reach[i];
}

/// A triangle's planes at the base of a square.
struct Aim {
  float e0[4];
  float edges_sure, own_sure;  ///< K of the float filter
};

// With r >= |q| (the grain, 2^-24 of which q is off) a sum in floats is off by at most K = 10.1 u r + rho (R
// + reach), or cannot have the wrong sign at all (|e0| > 2r); R <= |base| + r, by coordinates. An edge that
// points nearly at the light has a large rho: the own plane, which then is what tells, has its own K.
SIMD_INLINE Aim aim_at(const LeafTriangle& t, const points::PointBase& from, const glm::dvec3& origin) {
  using Double4 = Pack<double, 4>;
  double base[3];
  for (int k = 0; k < 3; ++k) base[k] = static_cast<double>(from.at[k]) - origin[k];
  Double4 e = load<Double4>(t.mx) * broadcast<Double4>(base[0]) - load<Double4>(t.d);
  e = mul_add(load<Double4>(t.my), broadcast<Double4>(base[1]), e);
  Aim aim;
  store(demoted(mul_add(load<Double4>(t.mz), broadcast<Double4>(base[2]), e)), aim.e0);
  const auto reach =
      static_cast<float>(std::abs(base[0]) + std::abs(base[1]) + std::abs(base[2])) + from.grain;
  const auto sure = [&](float rho) {
    return (10.1f * u * from.grain + rho * (reach + t.reach)) * (1 + 32 * u) + 0x1p-122f;
  };
  aim.edges_sure = sure(t.rho), aim.own_sure = sure(t.own_rho);
  return aim;
}

/// A closer verdict, for where the rough one leaves something open.
SIMD_INLINE TileVerdict fine_verdict(const ClusterPlanes& c, int i, const points::PointTile& tile,
                                     const points::PointBase& from, const glm::dvec3& origin, float tau) {
  LeafTriangle t;
  take_triangle(c, i, t);
  const Aim aim = aim_at(t, from, origin);
  const Pack3<Float16> q{load<Float16>(tile.qx), load<Float16>(tile.qy), load<Float16>(tile.qz)};
  const auto value = [&](int k) HWY_ATTR {
    const Pack3<Float16> m = broadcast3<Float16>(t.fx[k], t.fy[k], t.fz[k]);
    return mul_add(m.z, q.z, mul_add(m.y, q.y, mul_add(m.x, q.x, broadcast<Float16>(aim.e0[k]))));
  };
  const Float16 edges = min(value(0), min(value(1), value(2))), own = value(3);
  const Float16 off = broadcast<Float16>(aim.edges_sure),
                own_off = broadcast<Float16>(aim.own_sure + 2.5f * u * tau), zero = broadcast<Float16>(0.0f);
  return {0xffffu & ~bits(lt(edges, zero - off) | lt(own, zero - own_off)),
          bits(lt(off, edges) & lt(own_off, own - broadcast<Float16>(tau)))};
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
