// Sixteen rays of a tile against one triangle: planes at the base of the tile's square in double, the rest in
// float. Included once per target.
#if defined(TENEBRA_RAY_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_RAY_TEST_INL_H_
#undef TENEBRA_RAY_TEST_INL_H_
#else
#define TENEBRA_RAY_TEST_INL_H_
#endif

#include <cmath>

#include "shadow/tiles/descent.h"
#include "shadow/tiles/face_tests-inl.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// One of a cluster's triangles, its four planes side by side.
struct LeafTriangle {
  double mx[4], my[4], mz[4], d[4];
  float fx[4], fy[4], fz[4];
  float rho, reach;
  std::uint32_t id;
};

HWY_INLINE void take_triangle(const ClusterPlanes& c, int i, std::uint32_t id, LeafTriangle& t) {
  for (int k = 0; k < 4; ++k) {
    t.mx[k] = c.mx[k][i], t.my[k] = c.my[k][i], t.mz[k] = c.mz[k][i];
    t.d[k] = k == 3 ? c.d[i] : 0.0;
    t.fx[k] = c.fx[k][i], t.fy[k] = c.fy[k][i], t.fz[k] = c.fz[k][i];
  }
  t.rho = c.rho[i], t.reach = c.reach[i];
  t.id = id;
}

/// A triangle's planes at the base of a square.
struct Aim {
  std::uint32_t square;
  float e0[4];
  float sure;  ///< K of the float filter
};
inline constexpr std::uint32_t no_square = 0xffffffffu;

// With r >= |q| a sum in floats is off by at most K = 10.1 u r + rho (R + reach), or cannot have the wrong
// sign at all (|e0| > 2r); R <= |base| + r, by coordinates.
HWY_INLINE void take_aim(const LeafTriangle& t, const PointTile& tile, const glm::dvec3& light, Aim& aim) {
  using Double4 = Pack<double, 4>;
  double base[3];
  for (int k = 0; k < 3; ++k) base[k] = static_cast<double>(tile.base[k]) - light[k];
  Double4 e = load<Double4>(t.mx) * splat<Double4>(base[0]) - load<Double4>(t.d);
  e = multiply_add(load<Double4>(t.my), splat<Double4>(base[1]), e);
  store(demoted(multiply_add(load<Double4>(t.mz), splat<Double4>(base[2]), e)), aim.e0);
  const auto reach =
      static_cast<float>(std::abs(base[0]) + std::abs(base[1]) + std::abs(base[2])) + tile.radius;
  aim.sure = (10.1f * u * tile.radius + t.rho * (reach + t.reach)) * (1 + 32 * u) + 0x1p-122f;
}

/// Lanes of a tile.
struct Verdict {
  std::uint32_t near;  ///< not missed for sure
  std::uint32_t sure;  ///< blocked for sure, of those that are near
};

/// The own plane opens tau of the rays' own triangles later.
HWY_INLINE Verdict test_rays(const LeafTriangle& t, const Aim& aim, const PointTile& tile, float tau) {
  const Pack3<Float16> q{load<Float16>(tile.qx), load<Float16>(tile.qy), load<Float16>(tile.qz)};
  const auto value = [&](int k) HWY_ATTR {
    const Pack3<Float16> m = splat3<Float16>(t.fx[k], t.fy[k], t.fz[k]);
    return multiply_add(m.z, q.z, multiply_add(m.y, q.y, multiply_add(m.x, q.x, splat<Float16>(aim.e0[k]))));
  };
  const Float16 edges = min(value(0), min(value(1), value(2))), own = value(3);
  const float k = aim.sure + 2.5f * u * tau;
  return {0xffffu & ~less_bits(min(edges, own), splat<Float16>(-k)),
          less_bits(splat<Float16>(k), min(edges, own - splat<Float16>(tau)))};
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
