#include "bench/sun/sun_peer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra::bench {
namespace {

constexpr std::size_t block = 1024;  // points

/// As Embree's own types lay them out, for any number.
template <std::size_t lanes>
using Rays = RTCRayNt<static_cast<int>(lanes)>;

template <std::size_t lanes>
void occluded(ao::EmbreeQuery& query, const int* valid, RTCScene scene, Rays<lanes>& rays) {
  if constexpr (lanes == 16) {
    query.occluded16(valid, scene, reinterpret_cast<RTCRay16&>(rays));
  } else if constexpr (lanes == 8) {
    query.occluded8(valid, scene, reinterpret_cast<RTCRay8&>(rays));
  } else if constexpr (lanes == 4) {
    query.occluded4(valid, scene, reinterpret_cast<RTCRay4&>(rays));
  } else {
    query.occluded1(scene, reinterpret_cast<RTCRay&>(rays));
  }
}

/// Suns as planes of floats.
struct Sky {
  std::vector<float> x, y, z;
  std::vector<double> weight;

  explicit Sky(std::span<const sun::Sun> suns) {
    for (const sun::Sun& sun : suns) {
      x.push_back(static_cast<float>(sun.to_sun.x)), y.push_back(static_cast<float>(sun.to_sun.y));
      z.push_back(static_cast<float>(sun.to_sun.z)), weight.push_back(sun.weight);
    }
  }
};

/// A thread's packets of `lanes` rays through a block of points.
template <std::size_t lanes>
class BlockTracer {
public:
  BlockTracer(RTCScene scene, const PeerPlaces& places, const Sky& sky, std::span<double> sums)
      : scene_(scene), places_(places), sky_(sky), sums_(sums) {
    std::fill(rays_.mask, rays_.mask + lanes, ~0u);
  }

  void trace(std::size_t first, SunPacking packing) {
    if (packing == SunPacking::suns_then_points) {
      for (std::size_t s = 0; s < sky_.x.size(); ++s)
        for (std::size_t at = first; at < first + block; at += lanes) take_points(at), meet_sun(at, s);
      return;
    }
    for (std::size_t at = first; at < first + block; at += lanes) {
      if (packing == SunPacking::suns_of_a_point) {
        for (std::size_t i = at; i < at + lanes; ++i) meet_suns(i);
        continue;
      }
      take_points(at);
      for (std::size_t s = 0; s < sky_.x.size(); ++s) meet_sun(at, s);
    }
  }

private:
  void take_points(std::size_t at) {
    std::copy_n(&places_.x[at], lanes, rays_.org_x), std::copy_n(&places_.y[at], lanes, rays_.org_y);
    std::copy_n(&places_.z[at], lanes, rays_.org_z);
  }
  /// The points of one packet to one sun.
  void meet_sun(std::size_t at, std::size_t s) {
    const float x = sky_.x[s], y = sky_.y[s], z = sky_.z[s];
    const float *nx = &places_.nx[at], *ny = &places_.ny[at], *nz = &places_.nz[at];
    int any = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
      valid_[i] = nx[i] * x + ny[i] * y + nz[i] * z > 0 ? -1 : 0;
      any |= valid_[i];
      rays_.dir_x[i] = x, rays_.dir_y[i] = y, rays_.dir_z[i] = z;
      rays_.tfar[i] = std::numeric_limits<float>::infinity();
    }
    if (any == 0) return;
    occluded<lanes>(query_, valid_, scene_, rays_);
    for (std::size_t i = 0; i < lanes; ++i)
      if (valid_[i] != 0 && rays_.tfar[i] >= 0) sums_[at + i] += sky_.weight[s];
  }
  /// One point to all suns that it faces.
  void meet_suns(std::size_t i) {
    std::size_t filled = 0;
    std::fill(rays_.org_x, rays_.org_x + lanes, places_.x[i]);
    std::fill(rays_.org_y, rays_.org_y + lanes, places_.y[i]);
    std::fill(rays_.org_z, rays_.org_z + lanes, places_.z[i]);
    for (std::size_t s = 0; s < sky_.x.size(); ++s) {
      if (!(places_.nx[i] * sky_.x[s] + places_.ny[i] * sky_.y[s] + places_.nz[i] * sky_.z[s] > 0)) continue;
      rays_.dir_x[filled] = sky_.x[s], rays_.dir_y[filled] = sky_.y[s], rays_.dir_z[filled] = sky_.z[s];
      weights_[filled] = sky_.weight[s];
      if (++filled == lanes) meet_filled(i, filled), filled = 0;
    }
    if (filled > 0) meet_filled(i, filled);
  }
  void meet_filled(std::size_t point, std::size_t filled) {
    for (std::size_t k = 0; k < lanes; ++k) {
      valid_[k] = k < filled ? -1 : 0;
      rays_.tfar[k] = std::numeric_limits<float>::infinity();
    }
    occluded<lanes>(query_, valid_, scene_, rays_);
    for (std::size_t k = 0; k < filled; ++k)
      if (rays_.tfar[k] >= 0) sums_[point] += weights_[k];
  }

  RTCScene scene_;
  const PeerPlaces& places_;
  const Sky& sky_;
  std::span<double> sums_;  // of each point
  ao::EmbreeQuery query_{ao::EmbreeQuery::coherent};
  alignas(64) Rays<lanes> rays_{};
  alignas(64) int valid_[lanes];
  double weights_[lanes];
};

template <std::size_t lanes>
void trace_block(RTCScene scene, const PeerPlaces& places, const Sky& sky, std::span<double> sums,
                 std::size_t first, SunPacking packing) {
  BlockTracer<lanes> tracer(scene, places, sky, sums);
  tracer.trace(first, packing);
}

/// 21 bits, two apart.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffu, x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu, x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

/// Numbers of the receivers along Morton's curve.
std::vector<std::uint32_t> along_a_curve(const sun::Receivers& receivers) {
  glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (const sun::Receiver& r : receivers.list)
    low = glm::min(low, r.centre), high = glm::max(high, r.centre);
  const double scale = ((1 << 21) - 1) / std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-9});
  std::vector<std::uint64_t> keys;
  for (const sun::Receiver& r : receivers.list) {
    const glm::dvec3 at = (r.centre - low) * scale;
    keys.push_back(spread_bits(static_cast<std::uint64_t>(at.x)) << 2 |
                   spread_bits(static_cast<std::uint64_t>(at.y)) << 1 |
                   spread_bits(static_cast<std::uint64_t>(at.z)));
  }
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  return order;
}

}  // namespace

std::vector<SunPlan> sun_plans(const EmbreeScene& casters) {
  RTCDevice device = rtcGetSceneDevice(casters.get());
  const bool sixteen = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0,
             eight = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
  rtcReleaseDevice(device);
  std::vector<SunPlan> plans;
  for (const SunPacking packing :
       {SunPacking::points_then_suns, SunPacking::suns_then_points, SunPacking::suns_of_a_point})
    for (const int width : {16, 8, 4, 1})
      for (const bool sorted : {false, true})
        if ((width != 16 || sixteen) && (width != 8 || eight)) plans.push_back({packing, width, sorted});
  return plans;
}

std::string sun_plan_name(const SunPlan& plan) {
  constexpr const char* names[] = {"points, suns inside", "points, suns outside", "suns"};
  return fmt::format("{} {}{}", plan.width, names[static_cast<std::size_t>(plan.packing)],
                     plan.sorted ? ", sorted" : "");
}

PeerPlaces peer_places(const sun::Receivers& receivers, const TriangleView& triangles, bool sorted,
                       float lift_m) {
  std::vector<std::uint32_t> order(receivers.list.size());
  std::iota(order.begin(), order.end(), 0u);
  if (sorted) order = along_a_curve(receivers);
  PeerPlaces out;
  for (const std::uint32_t r : order) {
    for (std::uint32_t i = r == 0 ? 0 : receivers.list[r - 1].end; i < receivers.list[r].end; ++i) {
      const points::Corners c = points::corners_of(triangles, receivers.triangles[i]);
      const glm::dvec3 a(c.v[0]),
          n = glm::normalize(glm::cross(glm::dvec3(c.v[1]) - a, glm::dvec3(c.v[2]) - a));
      const glm::vec3 at(receivers.positions[i] + static_cast<double>(lift_m) * n), normal(n);
      out.x.push_back(at.x), out.y.push_back(at.y), out.z.push_back(at.z);
      out.nx.push_back(normal.x), out.ny.push_back(normal.y), out.nz.push_back(normal.z);
      out.receiver.push_back(r);
    }
  }
  const std::size_t padded = (out.x.size() + block - 1) / block * block;
  for (auto* plane : {&out.x, &out.y, &out.z, &out.nx, &out.ny, &out.nz}) plane->resize(padded, 0.0f);
  return out;
}

std::vector<double> peer_sums(const EmbreeScene& casters, const PeerPlaces& places, std::size_t receivers,
                              std::span<const sun::Sun> suns, const SunPlan& plan) {
  const Sky sky(suns);
  std::vector<double> sums(places.x.size());
  parallel::parallel_tasks(static_cast<int>(places.x.size() / block), [&](int part) {
    const std::size_t first = block * static_cast<std::size_t>(part);
    if (plan.width == 16) trace_block<16>(casters.get(), places, sky, sums, first, plan.packing);
    if (plan.width == 8) trace_block<8>(casters.get(), places, sky, sums, first, plan.packing);
    if (plan.width == 4) trace_block<4>(casters.get(), places, sky, sums, first, plan.packing);
    if (plan.width == 1) trace_block<1>(casters.get(), places, sky, sums, first, plan.packing);
  });
  std::vector<double> means(receivers), points(receivers);
  for (std::size_t i = 0; i < places.receiver.size(); ++i)
    means[places.receiver[i]] += sums[i], ++points[places.receiver[i]];
  for (std::size_t r = 0; r < receivers; ++r) means[r] /= points[r];
  return means;
}

}  // namespace tenebra::bench
