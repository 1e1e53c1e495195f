#include "bench/common/ray_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/common/ray_tile.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <limits>

#include "simd/dispatch.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::bench::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;
namespace {

// Rays leave their own surface by this share of their length; of a directional light's, by this share of the
// scene's width.
constexpr float bias = 1e-4f, far_bias = 1e-5f;

template <int N>
using Floats = Pack<float, N>;
template <int N>
using Vectors = Pack3<Floats<N>>;

template <int N>
SIMD_INLINE Vectors<N> spread(const glm::vec3& v) {
  return broadcast3<Floats<N>>(v.x, v.y, v.z);
}
template <int N>
SIMD_INLINE Vectors<N> load_planes(const float* x, const float* y, const float* z, int first) {
  return {load<Floats<N>>(x + first), load<Floats<N>>(y + first), load<Floats<N>>(z + first)};
}
template <int N>
SIMD_INLINE Vectors<N> minus(const Vectors<N>& a, const Vectors<N>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
/// a + s b
template <int N>
SIMD_INLINE Vectors<N> along(const Vectors<N>& a, Floats<N> s, const Vectors<N>& b) {
  return {mul_add(s, b.x, a.x), mul_add(s, b.y, a.y), mul_add(s, b.z, a.z)};
}
template <int N>
SIMD_INLINE void put(const Vectors<N>& v, float* x, float* y, float* z) {
  store(v.x, x), store(v.y, y), store(v.z, z);
}

template <int N>
SIMD_INLINE Vectors<N> directions(const ViewRays& view, const TileLanes& lanes, int first, float x, float y) {
  const Floats<N> px = load<Floats<N>>(lanes.x + first) + broadcast<Floats<N>>(x + 0.5f);
  const Floats<N> py = load<Floats<N>>(lanes.y + first) + broadcast<Floats<N>>(y + 0.5f);
  return along<N>(along<N>(spread<N>(view.d0), px, spread<N>(view.dx)), py, spread<N>(view.dy));
}

void place(const TilePlanes& planes, const ViewRays& view, const TileLanes& lanes, float x, float y,
           TilePoints& points) {
  const Vectors<16> direction = directions<16>(view, lanes, 0, x, y);
  const Vectors<16> n = load_planes<16>(planes.nx, planes.ny, planes.nz, 0);
  const Float16 t = load<Float16>(planes.d) / dot(n, direction);
  put<16>(along<16>(spread<16>(view.eye), t, direction), points.x, points.y, points.z);
}

template <int N, class Hits>
void look(const ViewRays& view, const TileLanes& lanes, int first, float x, float y, Hits& hits) {
  auto& rays = hits.ray;
  const glm::vec3 axis = glm::normalize(glm::cross(view.dx, view.dy));  // rays reach the near plane together
  put<N>(spread<N>(view.eye), rays.org_x, rays.org_y, rays.org_z);
  put<N>(directions<N>(view, lanes, first, x, y), rays.dir_x, rays.dir_y, rays.dir_z);
  store(broadcast<Floats<N>>(view.near_m / std::abs(glm::dot(axis, view.d0))), rays.tnear);
  store(broadcast<Floats<N>>(std::numeric_limits<float>::infinity()), rays.tfar);
  for (int i = 0; i < N; ++i) hits.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
}

template <int N, class Hits>
void met(const Hits& hits, int first, TilePlanes& planes, TilePoints& points) {
  const auto& rays = hits.ray;
  const Vectors<N> direction = load_planes<N>(rays.dir_x, rays.dir_y, rays.dir_z, 0);
  const Vectors<N> eye = load_planes<N>(rays.org_x, rays.org_y, rays.org_z, 0);
  const Floats<N> t = load<Floats<N>>(rays.tfar);
  // Rays that met nothing are infinite: no plane.
  const Floats<N> zero = broadcast<Floats<N>>(0.0f);
  const Mask<float, N> there = lt(t, broadcast<Floats<N>>(std::numeric_limits<float>::infinity()));
  const Vectors<N> n = load_planes<N>(hits.hit.Ng_x, hits.hit.Ng_y, hits.hit.Ng_z, 0);
  put<N>({select(there, n.x, zero), select(there, n.y, zero), select(there, n.z, zero)}, planes.nx + first,
         planes.ny + first, planes.nz + first);
  store(select(there, t * dot(n, direction), zero), planes.d + first);
  put<N>(along<N>(eye, t, direction), points.x + first, points.y + first, points.z + first);
}

template <int N, class Rays>
bool aim(const TilePlanes& planes, const TilePoints& points, int first, const LightAim& light, Rays& rays,
         std::int32_t* valid) {
  const Vectors<N> n = load_planes<N>(planes.nx, planes.ny, planes.nz, first);
  const Vectors<N> p = load_planes<N>(points.x, points.y, points.z, first);
  const Floats<N> d = load<Floats<N>>(planes.d + first), zero = broadcast<Floats<N>>(0.0f);
  Floats<N> side = dot(n, spread<N>(light.from_eye));
  Vectors<N> towards = spread<N>(light.step);
  if (!light.directional) {
    side = side - d;
    towards = minus<N>(spread<N>(light.place), p);
  }
  Mask<float, N> active = lt(side * d, zero);  // eye and light on one side: n.(eye - a) is -d
  if (!light.directional) {
    const Floats<N> squared = dot(towards, towards);
    active = active & lt(squared, broadcast<Floats<N>>(light.range_squared));
    if (light.spot_cos > -1) {
      const Floats<N> ahead = zero - dot(towards, spread<N>(light.spot_axis));
      active = active & lt(broadcast<Floats<N>>(light.spot_cos) * sqrt(squared), ahead);
    }
  }
  const Floats<N> far_end = broadcast<Floats<N>>(1 - (light.directional ? far_bias : bias));
  if (light.way == RayWay::to_light) {
    put<N>(p, rays.org_x, rays.org_y, rays.org_z);
    put<N>(towards, rays.dir_x, rays.dir_y, rays.dir_z);
    store(broadcast<Floats<N>>(light.directional ? far_bias : bias), rays.tnear);
    store(broadcast<Floats<N>>(1.0f), rays.tfar);
  } else {
    const Vectors<N> from = light.directional ? Vectors<N>{p.x + towards.x, p.y + towards.y, p.z + towards.z}
                                              : spread<N>(light.place);
    put<N>(from, rays.org_x, rays.org_y, rays.org_z);
    put<N>({zero - towards.x, zero - towards.y, zero - towards.z}, rays.dir_x, rays.dir_y, rays.dir_z);
    store(zero, rays.tnear);
    store(far_end, rays.tfar);
  }
  using Ints = Pack<std::int32_t, N>;
  store(select(active, broadcast<Ints>(-1), broadcast<Ints>(0)), valid);
  return bits(active) != 0;
}

/// Embree sets tfar of a blocked ray to -infinity.
template <int N, class Rays>
std::uint32_t lit(const Rays& rays, const std::int32_t* valid) {
  using Ints = Pack<std::int32_t, N>;
  const Mask<float, N> free = lt(broadcast<Floats<N>>(0.0f), load<Floats<N>>(rays.tfar));
  const Ints kept = select(free, load<Ints>(valid), broadcast<Ints>(0));
  return bits(gt(broadcast<Ints>(0), kept));
}

template <int N, class Hits, class Rays>
bench::PacketCode<Hits, Rays> packet_code() {
  return {look<N, Hits>, met<N, Hits>, aim<N, Rays>, lit<N, Rays>};
}

}  // namespace

bench::RayTileKernels ray_tile_kernels() {
  return {place, packet_code<16, RTCRayHit16, RTCRay16>(), packet_code<8, RTCRayHit8, RTCRay8>(),
          packet_code<4, RTCRayHit4, RTCRay4>()};
}

}  // namespace tenebra::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::bench {

TileLanes TileLanes::of(TileShape shape) {
  TileLanes lanes{};
  const int blocks = shape == TileShape::square ? 2 : 4;  // in a row
  for (int i = 0; i < 16; ++i) {
    lanes.x[i] = static_cast<float>(i / 4 % blocks * 2 + i % 2);
    lanes.y[i] = static_cast<float>(i / 4 / blocks * 2 + i / 2 % 2);
  }
  return lanes;
}

LightAim aim_at(const ShadowLight& light, const glm::vec3& eye, RayWay way, float wide_m) {
  LightAim aim;
  aim.directional = light.directional;
  aim.way = way;
  aim.place = light.position;
  aim.step = glm::normalize(light.to_light) * wide_m;
  aim.from_eye = light.directional ? aim.step : light.position - eye;
  aim.spot_axis = light.spot_axis;
  aim.spot_cos = light.spot_cos_outer;
  aim.range_squared =
      light.range_m > 0 ? light.range_m * light.range_m : std::numeric_limits<float>::infinity();
  return aim;
}

RayTileKernels ray_tile_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, ray_tile_kernels)();
}

}  // namespace tenebra::bench
#endif
