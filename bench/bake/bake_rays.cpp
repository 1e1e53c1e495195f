#include "bench/bake/bake_rays.h"

#include <algorithm>
#include <cmath>

#include "bench/soft/soft_quality.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr std::size_t lanes = 16, texel_patterns = 256, tile_patterns = 16 * lanes;

/// The weights of the rays that are to be traced, before Embree is asked.
void add_all(const RayPacket16& packet, float* all) {
  for (std::size_t lane = 0; lane < lanes; ++lane) all[lane] += packet.weight[lane];
}

}  // namespace

const char* ray_sum_name(RaySum sum) {
  return sum == RaySum::plain ? "plain" : "scaled";
}

std::vector<SampledReceiver> texel_receivers(const FrameGeometry& geometry,
                                             std::span<const bake::Sample> samples, float lift_m) {
  std::vector<SampledReceiver> receivers(samples.size());
  parallel::parallel_ranges(samples.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const glm::uvec3 t = geometry.triangles[samples[i].triangle];
      dvec3 corners[3], position(0.0), normal(0.0);
      for (int k = 0; k < 3; ++k) {
        corners[k] = dvec3(geometry.positions[t[k]]);
        position += samples[i].weights[k] * corners[k];
        normal += samples[i].weights[k] * dvec3(geometry.normals[t[k]]);
      }
      dvec3 face = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
      if (glm::dot(face, normal) < 0) face = -face;
      const double length = glm::length(normal);
      receivers[i] = {vec3(position + static_cast<double>(lift_m) * face),
                      length > 1e-6 ? vec3(normal / length) : vec3(face), vec3(face)};
    }
  });
  return receivers;
}

float open_irradiance(const AreaLight& light, const SampledReceiver& receiver) {
  const std::size_t count = light.vertices.size();
  vec3 to[14];
  bool whole = true, any = false;
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = light.vertices[i] - receiver.position;
    const bool above =
        std::min(glm::dot(to[i], receiver.normal), glm::dot(to[i], receiver.geometric_normal)) >= 0;
    whole &= above, any |= above;
  }
  if (!any || glm::dot(vec3(light.normal), to[0]) >= 0) return 0;
  if (!whole)
    return static_cast<float>(
        unoccluded(light, dvec3(receiver.position), dvec3(receiver.normal), dvec3(receiver.geometric_normal))
            .irradiance);
  float sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const vec3 &a = to[i], &b = to[i + 1 == count ? 0 : i + 1], across = glm::cross(a, b);
    const float length = glm::length(across);
    if (length > 0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(across, receiver.normal) / length;
  }
  return 0.5f * std::abs(sum);
}

/// Of sixteen rays, or of those of sixteen receivers.
struct BakeRays::Sums {
  alignas(64) float seen[lanes] = {};
  alignas(64) float all[lanes] = {};
};

BakeRays::BakeRays(const AreaLight& light, std::size_t rays, Packing packing, RaySum sum)
    : light_(light),
      samples_(packing == Packing::pixel ? samples_by_pixel(light, rays, texel_patterns)
                                         : samples_by_tile(light, rays, tile_patterns)),
      packing_(packing),
      sum_(sum),
      normal_(light.normal),
      area_of_a_ray_(static_cast<float>(light.area_m2 / static_cast<double>(rays))),
      kernels_(packet_kernels()) {}

float BakeRays::light_of(const SampledReceiver& receiver, float seen, float all) const {
  if (sum_ == RaySum::plain) return seen * area_of_a_ray_;
  return seen > 0 ? seen / all * open_irradiance(light_, receiver) : 0.0f;
}

void BakeRays::trace_texel(RTCScene casters, const SampledReceiver& receiver, std::size_t number,
                           Sums& sums) const {
  ao::EmbreeQuery query(ao::EmbreeQuery::coherent);
  ReceiverPacket from;
  RayPacket16 packet;
  for (std::size_t lane = 0; lane < lanes; ++lane) put(from, lane, receiver);
  start_rays(from, packet);
  const std::size_t stride = std::max(samples_.per_pattern, lanes);
  const std::size_t pattern = scattered(number) % samples_.pattern_count * stride;
  for (std::size_t s = pattern; s < pattern + samples_.per_pattern; s += lanes) {
    if (!kernels_.aim(from, &samples_.x[s], &samples_.y[s], &samples_.z[s], normal_.x, normal_.y, normal_.z,
                      packet))
      continue;
    for (std::size_t lane = samples_.per_pattern; lane < lanes; ++lane)  // fewer points than lanes
      packet.valid[lane] = 0, packet.weight[lane] = 0;
    add_all(packet, sums.all);
    query.occluded16(packet.valid, casters, packet.rays);
    kernels_.gather(packet, sums.seen);
  }
}

void BakeRays::trace_sixteen(RTCScene casters, std::span<const SampledReceiver> receivers, std::size_t number,
                             Sums& sums) const {
  ao::EmbreeQuery query(ao::EmbreeQuery::coherent);
  ReceiverPacket from{};  // no normal, no ray
  RayPacket16 packet;
  for (std::size_t lane = 0; lane < receivers.size(); ++lane) put(from, lane, receivers[lane]);
  start_rays(from, packet);
  const std::size_t block = scattered(number) % (samples_.pattern_count / lanes) * samples_.per_pattern;
  for (std::size_t cell = block; cell < block + samples_.per_pattern; ++cell) {
    const std::size_t s = cell * lanes;
    if (!kernels_.aim(from, &samples_.x[s], &samples_.y[s], &samples_.z[s], normal_.x, normal_.y, normal_.z,
                      packet))
      continue;
    add_all(packet, sums.all);
    query.occluded16(packet.valid, casters, packet.rays);
    kernels_.gather(packet, sums.seen);
  }
}

void BakeRays::trace(const EmbreeScene& casters, std::span<const SampledReceiver> receivers,
                     std::span<float> irradiance) const {
  parallel::parallel_ranges(
      (receivers.size() + lanes - 1) / lanes, 16, [&](std::size_t first, std::size_t last) {
        for (std::size_t tile = first; tile < last; ++tile) {
          const std::size_t begin = tile * lanes;
          const auto of_tile = receivers.subspan(begin, std::min(lanes, receivers.size() - begin));
          if (packing_ == Packing::tile) {
            Sums sums;
            trace_sixteen(casters.get(), of_tile, tile, sums);
            for (std::size_t i = 0; i < of_tile.size(); ++i)
              irradiance[begin + i] = light_of(of_tile[i], sums.seen[i], sums.all[i]);
            continue;
          }
          for (std::size_t i = 0; i < of_tile.size(); ++i) {
            Sums sums;
            trace_texel(casters.get(), of_tile[i], begin + i, sums);
            float seen = 0, all = 0;
            for (std::size_t lane = 0; lane < lanes; ++lane) seen += sums.seen[lane], all += sums.all[lane];
            irradiance[begin + i] = light_of(of_tile[i], seen, all);
          }
        }
      });
}

}  // namespace tenebra::bench
