#include "bench/common/packet_kernels.h"

// As in the kernels of src: nothing here uses what these two add, so each would only be one more copy to
// compile.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/common/packet_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <tenebra/simd_level.h>
#include "simd/dispatch.h"
#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::bench::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;
namespace {

using Int16 = Pack<std::int32_t, 16>;

constexpr float almost_at_the_light = 1 - 0x1p-16f;

bool aim(const bench::ReceiverPacket& from, const float* x, const float* y, const float* z, float lx,
         float ly, float lz, bench::RayPacket16& out) {
  const Pack3<Float16> d{load<Float16>(x) - load<Float16>(from.x), load<Float16>(y) - load<Float16>(from.y),
                         load<Float16>(z) - load<Float16>(from.z)};
  const Pack3<Float16> n{load<Float16>(from.nx), load<Float16>(from.ny), load<Float16>(from.nz)};
  const Pack3<Float16> g{load<Float16>(from.gx), load<Float16>(from.gy), load<Float16>(from.gz)};
  const Float16 zero = broadcast<Float16>(0.0f);
  const Float16 square = dot(d, d), received = dot(n, d),
                sent = zero - dot(broadcast3<Float16>(lx, ly, lz), d);
  const Float16 weight = received * sent / (square * square);
  const Float16 least_side = min(min(received, sent), dot(g, d));
  store(select_le(least_side, zero, zero, weight), out.weight);
  store(select_le(least_side, zero, broadcast<Int16>(0), broadcast<Int16>(-1)), out.valid);
  store(d.x, out.rays.dir_x);
  store(d.y, out.rays.dir_y);
  store(d.z, out.rays.dir_z);
  store(broadcast<Float16>(almost_at_the_light), out.rays.tfar);
  return reduce_max(least_side) > 0;
}

/// Embree sets tfar of a blocked ray to -infinity.
void gather(const bench::RayPacket16& traced, float* sums) {
  const Float16 zero = broadcast<Float16>(0.0f);
  const Float16 seen = select_le(load<Float16>(traced.rays.tfar), zero, zero, load<Float16>(traced.weight));
  store(load<Float16>(sums) + seen, sums);
}

}  // namespace

bench::PacketKernels packet_kernels() {
  return {aim, gather};
}

}  // namespace tenebra::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::bench {

PacketKernels packet_kernels() {
  return TENEBRA_DISPATCH(SimdLevel::automatic, packet_kernels)();
}

}  // namespace tenebra::bench
#endif
