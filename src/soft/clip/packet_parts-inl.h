// Up to sixteen points of a group, one in each lane, and the fragments of the light that they see together.
// Included once per target.
#if defined(TENEBRA_SOFT_PACKET_PARTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_PACKET_PARTS_INL_H_
#undef TENEBRA_SOFT_PACKET_PARTS_INL_H_
#else
#define TENEBRA_SOFT_PACKET_PARTS_INL_H_
#endif

#include <algorithm>
#include <vector>

#include "soft/clip/packet_polygon-inl.h"
#include "soft/occluders/point_occluders-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Up to sixteen points of a group, as GroupPoint has them. Lanes beyond the count are copies of the last.
struct PacketPoints {
  std::size_t count = 0;
  double position[3][packet_size] = {};  ///< world space
  double receiver_tau[packet_size] = {};
  std::uint32_t receiver[packet_size] = {};
  double in_axes[3][packet_size] = {}, in_light[2][packet_size] = {}, reach[packet_size] = {};
  LightAxes axes;

  std::uint32_t touched = 0;  ///< bits of the points that lost some of the light
  bool failed = false;        ///< rounding is too delicate, or a polygon has too many vertices

  void add(const glm::dvec3& at, std::uint32_t on, double tau) {
    for (int c = 0; c < 3; ++c) position[c][count] = at[c];
    receiver[count] = on, receiver_tau[count] = tau;
    ++count;
  }
  void clear() {
    count = 0;
    touched = 0;
    failed = false;
  }

  /// Finds their places in these axes. Sums are not fused, as in group_point.
  HWY_NOINLINE void place_in(const LightAxes& group_axes) {
    axes = group_axes;
    for (auto& from : position) std::fill(from + count, from + packet_size, from[count - 1]);
    Wide way[3];
    for (int c = 0; c < 3; ++c) way[c] = load<Wide>(position[c]) - wide(axes.centre[c]);
    const auto along = [&](const glm::dvec3& a) {
      return wide(a.x) * way[0] + wide(a.y) * way[1] + wide(a.z) * way[2];
    };
    const Wide u = along(axes.u), v = along(axes.v), height = along(axes.height);
    store(u, in_axes[0]), store(v, in_axes[1]), store(height, in_axes[2]);
    const Wide weight = wide(axes.weight);
    store(wide(axes.centre_uv.x) + weight * u, in_light[0]);
    store(wide(axes.centre_uv.y) + weight * v, in_light[1]);
    store(wide(axes.centre_uv.z) - weight * height, reach);
  }
  GroupPoint point(std::size_t k) const {
    return group_point(axes, {position[0][k], position[1][k], position[2][k]}, receiver[k], receiver_tau[k]);
  }
};

inline PointRange range_of(const PacketPoints& at) {
  PointRange range{{}, {}, glm::dvec2(at.axes.centre_uv), at.axes.centre_uv.z, at.axes.weight};
  for (int c = 0; c < 3; ++c) {
    const Wide there = load<Wide>(at.in_axes[c]);
    range.low[c] = reduce_min(there), range.high[c] = reduce_max(there);
  }
  return range;
}

/// A fragment of the light that the points of the lanes `live` see.
struct alignas(64) PacketPart {
  PacketPolygon polygon;
  std::uint32_t live = 0;

  PacketPart() = default;
  PacketPart(const PacketPart& from) { *this = from; }
  PacketPart& operator=(const PacketPart& from) {  // NOLINT(cert-oop54-cpp): onto itself it changes nothing
    polygon.assign(from.polygon);
    live = from.live;
    return *this;
  }
  bool empty() const { return live == 0; }
};

inline const PacketPart& loaded(const PacketPart& part) {
  return part;
}

/// Takes repeated vertices out of a polygon that has many.
SIMD_INLINE void compact_large(PacketPolygon& polygon, std::uint32_t lanes) {
  constexpr int large = 6;  // vertices
  if (polygon.count > large) compact(polygon, lanes);
}

/// Greatest u, -least u, greatest v, -least v of the fragments of live lanes; for other lanes, values beyond
/// the light.
struct alignas(64) PacketReach {
  Float16 side[4];
};

SIMD_INLINE PacketReach bounds_of(const PacketPart& part) {
  const PacketPolygon& p = part.polygon;
  Float16 low_u = p.x[0], high_u = low_u, low_v = p.y[0], high_v = low_v;
  for (int k = 1; k < p.count; ++k) {
    low_u = min(low_u, p.x[k]), high_u = max(high_u, p.x[k]);
    low_v = min(low_v, p.y[k]), high_v = max(high_v, p.y[k]);
  }
  const Float16 zero = broadcast<Float16>(0.0f), none = broadcast<Float16>(-4.0f);
  const auto live = mask_of_bits<float, packet_size>(part.live);
  return {{select(live, high_u, none), select(live, zero - low_u, none), select(live, high_v, none),
           select(live, zero - low_v, none)}};
}

/// Around all lanes.
SIMD_INLINE LightBox<float> box_of(const PacketReach& reach) {
  const float u1 = reduce_max(reach.side[0]), u0 = -reduce_max(reach.side[1]);
  const float v1 = reduce_max(reach.side[2]), v0 = -reduce_max(reach.side[3]);
  return {(u0 + u1) / 2, (v0 + v1) / 2, (u1 - u0) / 2, (v1 - v0) / 2};
}
SIMD_INLINE LightBox<float> box_of(const PacketPart& part) {
  return box_of(bounds_of(part));
}

class PacketParts {
public:
  void clear() { size_ = 0; }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  PacketPart& operator[](std::size_t i) { return parts_[i]; }
  const PacketPart& operator[](std::size_t i) const { return parts_[i]; }
  void shrink(std::size_t size) { size_ = size; }
  void push(const PacketPart& part) { add() = part; }
  /// Valid until the list grows.
  PacketPart& add() {
    if (size_ == parts_.size()) grow();
    return parts_[size_++];
  }
  const PacketPart& pop() { return parts_[--size_]; }

private:
  HWY_NOINLINE void grow() { parts_.resize(2 * size_ + 16); }

  std::vector<PacketPart> parts_;
  std::size_t size_ = 0;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
