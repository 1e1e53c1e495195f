// The visible part of the light for sixteen points of a group, one in each lane: neighbours mostly see it cut
// by the same occluders in the same way. Included once per target.
#if defined(TENEBRA_SOFT_PACKET_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_PACKET_SOLVER_INL_H_
#undef TENEBRA_SOFT_PACKET_SOLVER_INL_H_
#else
#define TENEBRA_SOFT_PACKET_SOLVER_INL_H_
#endif

#include "soft/clip/clip_solver-inl.h"
#include "soft/clip/packet_occluders-inl.h"
#include "soft/polygon/irradiance-inl.h"
#include "soft/polygon/receiver_plane-inl.h"
#include "soft/polygon/whole_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Points are added, up to sixteen, and solved together; then their answers can be asked for until clear().
class PacketSolver {
public:
  /// Takes over the candidates of a group in places `order`, largest first.
  void reset(const GroupCandidates& group, std::span<const std::uint32_t> order, const StopFlag* stop) {
    clip_.reset(group, order, stop);
    points_.clear();
  }

  std::size_t count() const { return points_.count; }
  bool full() const { return points_.count == packet_size; }
  /// A point on `receiver`, in front of the light, with a unit shading normal.
  void add(const glm::dvec3& position, const glm::dvec3& normal, const ReceiverPlane& receiver) {
    const std::size_t k = points_.count;
    for (int c = 0; c < 3; ++c) normal_[c][k] = normal[c];
    receiver_horizon_.put(k, receiver.line, receiver.cuts_light);
    points_.add(position, receiver.id, receiver.tau);
  }
  void clear() { points_.clear(); }
  glm::dvec3 to_origin(std::size_t k) const { return {to_origin_[0][k], to_origin_[1][k], to_origin_[2][k]}; }
  glm::dvec3 normal(std::size_t k) const { return {normal_[0][k], normal_[1][k], normal_[2][k]}; }

  /// Finds what the points (at least one) see of the light; false, and nothing found, where rounding is too
  /// delicate or a polygon gets too many vertices: then they have to be solved one by one.
  HWY_NOINLINE bool solve(const LightFrame& light, const LightAxes& axes) {
    points_.place_in(axes);
    find_sight(light, 0);
    find_sight(light, 8);
    std::fill_n(area_, packet_size, 0.0);
    std::fill_n(irradiance_, packet_size, 0.0);
    fragments_ = 0;
    clip_.move_to(points_);
    visible_.clear();
    if (put_light(light)) clip_.query(light_, visible_);
    if (points_.failed) return false;
    whole_ = light_.live & ~(points_.touched | receiver_horizon_.cuts | shading_horizon_.cuts);
    for (std::size_t i = 0; i < visible_.size(); ++i) {
      visible_[i].live &= ~whole_;
      if (!visible_[i].empty()) add_visible(light, visible_[i]);
    }
    return !points_.failed;
  }
  /// Whether nothing hides any of the light from this point, and no horizon cuts it.
  bool sees_all(std::size_t k) const { return (whole_ >> k & 1u) != 0; }
  /// For the others: the visible area, in units of the light squared, and the irradiance that it sends.
  double area(std::size_t k) const { return 0.5 * area_[k]; }
  double irradiance(std::size_t k) const { return 0.5 * irradiance_[k]; }
  std::uint64_t fragments() const { return fragments_; }

private:
  /// A line in each lane; where it cuts nothing, one that is positive everywhere.
  struct Horizon {
    float u[packet_size] = {}, v[packet_size] = {}, w[packet_size] = {};
    std::uint32_t cuts = 0;

    void put(std::size_t k, const LightLine<float>& line, bool cuts_light) {
      u[k] = cuts_light ? line.u : 0.0f;
      v[k] = cuts_light ? line.v : 0.0f;
      w[k] = cuts_light ? line.w : 1.0f;
      cuts = (cuts & ~(1u << k)) | (cuts_light ? 1u << k : 0u);
    }
    SIMD_INLINE void put_eight(std::size_t first, const LightFrame& light, const HorizonLanes& line) {
      const Double8 zero = broadcast<Double8>(0.0), one = broadcast<Double8>(1.0);
      const std::uint32_t cut = line.cuts(light);
      const auto there = mask_of_bits<double, 8>(cut);
      const Double8 size = abs(line.u) + abs(line.v) + abs(line.w);
      const Double8 scale = select(there, one / select(lt(zero, size), size, one), zero);
      store_narrowed(line.u * scale, u + first);
      store_narrowed(line.v * scale, v + first);
      store_narrowed(select(there, line.w * scale, one), w + first);
      cuts = (cuts & ~(0xffu << first)) | cut << first;
    }
    PacketLine line() const { return {load<Float16>(u), load<Float16>(v), load<Float16>(w)}; }
  };

  /// How the points of eight lanes see the light.
  HWY_NOINLINE void find_sight(const LightFrame& light, std::size_t first) {
    Pack3<Double8> way, normal;
    const auto find = [&](int c, Double8& to) {
      to = broadcast<Double8>(light.origin[c]) -
           broadcast<Double8>(light.weight) * load<Double8>(points_.position[c] + first);
      store(to, to_origin_[c] + first);
    };
    find(0, way.x), find(1, way.y), find(2, way.z);
    normal = {load<Double8>(normal_[0] + first), load<Double8>(normal_[1] + first),
              load<Double8>(normal_[2] + first)};
    shading_horizon_.put_eight(first, light, horizon_of(light, way, normal));
  }

  /// The light above the receivers' planes; false if there is none.
  bool put_light(const LightFrame& light) {
    light_.live = (1u << points_.count) - 1u;
    light_.polygon.count = static_cast<int>(light.polygon.size());
    for (int k = 0; k < light_.polygon.count; ++k) {
      const glm::dvec2 at = light.polygon[static_cast<std::size_t>(k)];
      light_.polygon.x[k] = broadcast<Float16>(static_cast<float>(at.x));
      light_.polygon.y[k] = broadcast<Float16>(static_cast<float>(at.y));
    }
    keep_above(receiver_horizon_, light_);
    return !light_.empty();
  }

  /// Keeps the part above the horizons of its points.
  SIMD_INLINE void keep_above(const Horizon& horizon, PacketPart& part) {
    if ((horizon.cuts & part.live) == 0) return;
    PacketValues values = evaluate(part.polygon, horizon.line());
    part.live &= values.positive;
    const std::uint32_t cut = part.live & values.negative;
    if (cut == 0) return;
    if (split(part.polygon, values, cut, above_, below_)) {
      part.polygon.assign(above_);
    } else {
      points_.failed = true;
    }
  }

  /// Adds area and irradiance of a fragment to its lanes' sums.
  SIMD_INLINE void add_visible(const LightFrame& light, PacketPart& part) {
    fragments_ += static_cast<std::uint64_t>(std::popcount(part.live));
    for (int first = 0; first < packet_size; first += 8) add_area(part, first);
    keep_above(shading_horizon_, part);
    for (int first = 0; first < packet_size; first += 8) add_irradiance(light, part, first);
  }

  /// For the eight lanes from `first` on.
  HWY_NOINLINE void add_area(const PacketPart& part, int first) {
    const PacketPolygon& p = part.polygon;
    const std::uint32_t live = part.live >> first & 0xffu;
    if (live == 0) return;
    const Double8 zero = broadcast<Double8>(0.0);
    Double8 sum = zero;
    Double8 u0 = widened(p.x[p.count - 1], first), v0 = widened(p.y[p.count - 1], first);
    for (int k = 0; k < p.count; ++k) {
      const Double8 u1 = widened(p.x[k], first), v1 = widened(p.y[k], first);
      sum = sum + (u0 * v1 - u1 * v0);
      u0 = u1, v0 = v1;
    }
    store(load<Double8>(area_ + first) + select(mask_of_bits<double, 8>(live), sum, zero), area_ + first);
  }

  HWY_NOINLINE void add_irradiance(const LightFrame& light, const PacketPart& part, int first) {
    const PacketPolygon& p = part.polygon;
    const std::uint32_t live = part.live >> first & 0xffu;
    if (live == 0) return;
    const auto eight = [&](const double(&from)[3][packet_size]) {
      return Pack3<Double8>{load<Double8>(from[0] + first), load<Double8>(from[1] + first),
                            load<Double8>(from[2] + first)};
    };
    const Pack3<Double8> origin = eight(to_origin_), normal = eight(normal_);
    const Double8 zero = broadcast<Double8>(0.0);
    Double8 sum = zero;
    Double8 u0 = widened(p.x[p.count - 1], first), v0 = widened(p.y[p.count - 1], first);
    for (int k = 0; k < p.count; ++k) {
      const Double8 u1 = widened(p.x[k], first), v1 = widened(p.y[k], first);
      sum = sum - contour_term(on_light(light, origin, u0, v0),
                               on_light(light, {zero, zero, zero}, u1 - u0, v1 - v0), normal);
      u0 = u1, v0 = v1;
    }
    store(load<Double8>(irradiance_ + first) + select(mask_of_bits<double, 8>(live), sum, zero),
          irradiance_ + first);
  }

  static SIMD_INLINE Double8 widened(Float16 from, int first) {
    float lanes[packet_size];
    store(from, lanes);
    return load_widened<Double8>(lanes + first);
  }

  ClipSolver<ManyPoints> clip_;
  PacketPoints points_;
  double to_origin_[3][packet_size] = {}, normal_[3][packet_size] = {};
  Horizon receiver_horizon_, shading_horizon_;
  PacketPart light_;
  PacketPolygon above_, below_;
  PacketParts visible_;
  std::uint32_t whole_ = 0;
  double area_[packet_size] = {}, irradiance_[packet_size] = {};
  std::uint64_t fragments_ = 0;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
