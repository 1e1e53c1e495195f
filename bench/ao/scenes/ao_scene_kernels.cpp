#include "bench/ao/scenes/ao_scene_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/ao/scenes/ao_scene_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <tenebra/simd_level.h>
#include "simd/dispatch.h"
#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::bench::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;
namespace {

template <int N>
using Floats = Pack<float, N>;
template <int N>
using Vectors = Pack3<Floats<N>>;

template <int N>
SIMD_INLINE Vectors<N> load3(const float* x, const float* y, const float* z, std::ptrdiff_t at = 0) {
  return {load<Floats<N>>(x + at), load<Floats<N>>(y + at), load<Floats<N>>(z + at)};
}
template <int N>
SIMD_INLINE void store3(const Vectors<N>& v, float* x, float* y, float* z) {
  store(v.x, x), store(v.y, y), store(v.z, z);
}
/// a + s b
template <int N>
SIMD_INLINE Vectors<N> along(const Vectors<N>& a, Floats<N> s, const Vectors<N>& b) {
  return {mul_add(s, b.x, a.x), mul_add(s, b.y, a.y), mul_add(s, b.z, a.z)};
}
SIMD_INLINE Vectors<16> cross(const Vectors<16>& a, const Vectors<16>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
SIMD_INLINE Vectors<16> scaled(const Vectors<16>& a, Float16 s) {
  return {a.x * s, a.y * s, a.z * s};
}

/// Tangents without branches: Duff et al. 2017.
SIMD_INLINE void tangents(const Vectors<16>& n, bench::AoPointPacket& p) {
  const Float16 one = broadcast<Float16>(1.0f), zero = broadcast<Float16>(0.0f);
  const Float16 sign = select(lt(n.z, zero), zero - one, one);
  const Float16 a = (zero - one) / (sign + n.z), b = n.x * n.y * a;
  store3<16>({mul_add(sign * n.x * n.x, a, one), sign * b, zero - sign * n.x}, p.tx, p.ty, p.tz);
  store3<16>({b, mul_add(n.y * n.y, a, sign), zero - n.y}, p.ux, p.uy, p.uz);
}

void frame(bench::AoPointPacket& p, float lift, float least) {
  const Float16 zero = broadcast<Float16>(0.0f), one = broadcast<Float16>(1.0f);
  const Vectors<16> n = load3<16>(p.nx, p.ny, p.nz), at = load3<16>(p.x, p.y, p.z);
  Vectors<16> face = cross(load3<16>(p.ax, p.ay, p.az), load3<16>(p.bx, p.by, p.bz));
  const Float16 square = dot(face, face), size = one / sqrt(max(square, broadcast<Float16>(1e-37f)));
  face = scaled(face, select(lt(dot(face, n), zero), zero - size, size));
  const Float16 most = max(abs(at.x), max(abs(at.y), abs(at.z)));
  const Float16 off = max(most * broadcast<Float16>(lift), broadcast<Float16>(least));
  store3<16>(along<16>(at, off, face), p.x, p.y, p.z);
  store3<16>(face, p.ax, p.ay, p.az);
  tangents(n, p);
}

template <int N, class Hits>
void begin(const bench::AoPointPacket& p, int first, Hits& hits) {
  store3<N>(load3<N>(p.x, p.y, p.z, first), hits.ray.org_x, hits.ray.org_y, hits.ray.org_z);
}

template <int N, class Hits>
void spread(const bench::PatternRow& row, const bench::AoPointPacket& p, int first, float reach, Hits& hits) {
  const Vectors<N> local = load3<N>(row.x, row.y, row.z, first), face = load3<N>(p.ax, p.ay, p.az, first);
  const Vectors<N> n = load3<N>(p.nx, p.ny, p.nz, first);
  Vectors<N> d{n.x * local.z, n.y * local.z, n.z * local.z};
  d = along<N>(d, local.x, load3<N>(p.tx, p.ty, p.tz, first));
  d = along<N>(d, local.y, load3<N>(p.ux, p.uy, p.uz, first));
  const Floats<N> below = min(dot(d, face), broadcast<Floats<N>>(0.0f));
  d = along<N>(d, broadcast<Floats<N>>(-2.0f) * below, face);
  store3<N>(d, hits.ray.dir_x, hits.ray.dir_y, hits.ray.dir_z);
  store(broadcast<Floats<N>>(reach), hits.ray.tfar);
  store(broadcast<Pack<std::int32_t, N>>(-1), reinterpret_cast<std::int32_t*>(hits.hit.geomID));
}

template <int N, class Hits>
void gather(const Hits& hits, int first, float* sums) {
  store(load<Floats<N>>(sums + first) + load<Floats<N>>(hits.ray.tfar), sums + first);
}

/// How alike pixels are, 0..1: in one plane, near, facing alike.
SIMD_INLINE Float16 likeness(const Vectors<16>& p, const Vectors<16>& n, const Vectors<16>& q,
                             const Vectors<16>& m, const bench::AoFilterWeights& w) {
  const Float16 one = broadcast<Float16>(1.0f), zero = broadcast<Float16>(0.0f);
  const Vectors<16> away{q.x - p.x, q.y - p.y, q.z - p.z};
  const Float16 off = abs(dot(away, n)) * broadcast<Float16>(w.plane);
  const Float16 far = dot(away, away) * broadcast<Float16>(w.distance);
  const Float16 bent = (one - dot(n, m)) * broadcast<Float16>(w.bend);
  return max(one - off, zero) * max(one - far, zero) * max(one - bent, zero);
}

void filter(const bench::AoPixelPlanes& s, const float* from, float* to, std::ptrdiff_t at,
            std::ptrdiff_t pitch, int step, const bench::AoFilterWeights& w) {
  const Vectors<16> p = load3<16>(s.x, s.y, s.z, at), n = load3<16>(s.nx, s.ny, s.nz, at);
  const Float16 middle = broadcast<Float16>(w.tap[0] * w.tap[0]);
  Float16 sum = load<Float16>(from + at) * middle, weights = middle;
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      if (i == 0 && j == 0) continue;
      const std::ptrdiff_t there = at + j * step * pitch + i * step;
      const Float16 tap = broadcast<Float16>(w.tap[i < 0 ? -i : i] * w.tap[j < 0 ? -j : j]);
      const Float16 weight =
          tap * likeness(p, n, load3<16>(s.x, s.y, s.z, there), load3<16>(s.nx, s.ny, s.nz, there), w);
      sum = mul_add(weight, load<Float16>(from + there), sum);
      weights = weights + weight;
    }
  }
  store(min(sum / weights, broadcast<Float16>(1.0f)), to + at);
}

std::uint32_t join(const bench::AoPixelPlanes& s, const bench::AoPixelPlanes& o, const float* from, float* to,
                   std::ptrdiff_t at, const std::ptrdiff_t* offsets, int count,
                   const bench::AoFilterWeights& w) {
  const Vectors<16> p = load3<16>(s.x, s.y, s.z, at), n = load3<16>(s.nx, s.ny, s.nz, at);
  const Float16 zero = broadcast<Float16>(0.0f);
  Float16 sum = zero, weights = zero;
  for (int k = 0; k < count; ++k) {
    const std::ptrdiff_t there = at + offsets[k];
    const Float16 weight =
        likeness(p, n, load3<16>(o.x, o.y, o.z, there), load3<16>(o.nx, o.ny, o.nz, there), w);
    sum = mul_add(weight, load<Float16>(from + there), sum);
    weights = weights + weight;
  }
  store(min(sum / max(weights, broadcast<Float16>(1e-6f)), broadcast<Float16>(1.0f)), to + at);
  return lt_bits(weights, broadcast<Float16>(0.05f));
}

template <int N, class Hits>
bench::AoRayCode<Hits> ray_code() {
  return {spread<N, Hits>, begin<N, Hits>, gather<N, Hits>};
}

}  // namespace

bench::AoSceneKernels ao_scene_kernels() {
  return {frame, ray_code<16, RTCRayHit16>(), ray_code<8, RTCRayHit8>(), ray_code<4, RTCRayHit4>(), filter,
          join};
}

}  // namespace tenebra::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::bench {

AoSceneKernels ao_scene_kernels() {
  return TENEBRA_DISPATCH(SimdLevel::automatic, ao_scene_kernels)();
}

}  // namespace tenebra::bench
#endif
