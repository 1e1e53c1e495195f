#include "bench/soft/soft_embree.h"

#include <limits>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra::bench {
namespace {

constexpr std::size_t lanes = 16, tile_side = 4;
constexpr std::size_t pixel_patterns = 256, tile_patterns = 16 * lanes;

/// Nothing to ask for: not seen, no normal, or not wanted.
bool idle(const SampledReceiver& r) {
  return r.normal == glm::vec3(0);
}

}  // namespace

void put(ReceiverPacket& packet, std::size_t lane, const SampledReceiver& r) {
  packet.x[lane] = r.position.x, packet.y[lane] = r.position.y, packet.z[lane] = r.position.z;
  packet.nx[lane] = r.normal.x, packet.ny[lane] = r.normal.y, packet.nz[lane] = r.normal.z;
  packet.gx[lane] = r.geometric_normal.x, packet.gy[lane] = r.geometric_normal.y;
  packet.gz[lane] = r.geometric_normal.z;
}

void start_rays(const ReceiverPacket& from, RayPacket16& out) {
  std::copy(from.x, from.x + lanes, out.rays.org_x);
  std::copy(from.y, from.y + lanes, out.rays.org_y);
  std::copy(from.z, from.z + lanes, out.rays.org_z);
  std::fill(out.rays.tnear, out.rays.tnear + lanes, 0.0f);
  std::fill(out.rays.time, out.rays.time + lanes, 0.0f);
  std::fill(out.rays.mask, out.rays.mask + lanes, ~0u);
  std::fill(out.rays.flags, out.rays.flags + lanes, 0u);
}

const char* packing_name(Packing packing) {
  return packing == Packing::pixel ? "pixel" : "tile";
}

std::vector<SampledReceiver> sampled_receivers(const BenchFrame& frame) {
  std::vector<SampledReceiver> receivers(frame.pixel_count());
  const float lift_m = lift_of_diagonal * frame.diagonal_m;
  parallel::parallel_ranges(receivers.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t id = frame.points.triangles[i];
      if (id == no_triangle) continue;
      const glm::dvec3 p = frame.points.positions[i];
      const points::Corners c = points::corners_of(frame.triangles(), id);
      const glm::dvec3 a(c.v[0]), across = glm::cross(glm::dvec3(c.v[1]) - a, glm::dvec3(c.v[2]) - a);
      const double length = glm::length(across);
      if (!(length > 0)) continue;
      const glm::dvec3 to_eye =
          frame.view.orthographic ? -glm::dvec3(frame.view.d0) : glm::dvec3(frame.view.eye) - a;
      const glm::dvec3 n = across / (glm::dot(across, to_eye) < 0 ? -length : length);
      receivers[i] = {glm::vec3(p + static_cast<double>(lift_m) * n), frame.normals[i], glm::vec3(n)};
    }
  });
  return receivers;
}

struct SoftSampler::Job {
  RTCScene casters;
  std::span<const SampledReceiver> receivers;
  std::size_t width, height;
  std::span<const std::uint8_t> wanted;
  std::span<float> irradiance;

  bool wants(std::size_t pixel) const { return wanted.empty() || wanted[pixel] != 0; }
};

SoftSampler::SoftSampler(const AreaLight& light, std::size_t rays, Packing packing)
    : samples_(packing == Packing::pixel ? samples_by_pixel(light, rays, pixel_patterns)
                                         : samples_by_tile(light, rays, tile_patterns)),
      packing_(packing),
      normal_(light.normal),
      area_of_a_ray_(static_cast<float>(light.area_m2 / static_cast<double>(rays))),
      endless_(light.at_infinity),
      kernels_(packet_kernels()) {}

void SoftSampler::trace(const EmbreeScene& casters, std::span<const SampledReceiver> receivers, int width,
                        int height, std::span<const std::uint8_t> wanted, std::span<float> irradiance) const {
  const Job job{casters.get(), receivers, static_cast<std::size_t>(width), static_cast<std::size_t>(height),
                wanted,        irradiance};
  if (packing_ == Packing::pixel) {
    parallel::parallel_ranges(receivers.size(), 256,
                              [&](std::size_t first, std::size_t last) { trace_pixels(job, first, last); });
  } else {
    const std::size_t rows = (job.height + tile_side - 1) / tile_side;
    const std::size_t columns = (job.width + tile_side - 1) / tile_side;
    parallel::parallel_ranges(rows * columns, 16,
                              [&](std::size_t first, std::size_t last) { trace_tiles(job, first, last); });
  }
}

/// Whence the light is seen as its samples lie.
ReceiverPacket SoftSampler::aimed_from(const ReceiverPacket& from) const {
  ReceiverPacket aimed = from;
  if (endless_)
    for (auto* places : {aimed.x, aimed.y, aimed.z}) std::fill_n(places, lanes, 0.0f);
  return aimed;
}

/// Sixteen points of the light from `sample` on.
bool SoftSampler::aim(const ReceiverPacket& from, std::size_t sample, RayPacket16& out) const {
  const bool any = kernels_.aim(from, &samples_.x[sample], &samples_.y[sample], &samples_.z[sample],
                                normal_.x, normal_.y, normal_.z, out);
  if (endless_) std::fill_n(out.rays.tfar, lanes, std::numeric_limits<float>::infinity());
  return any;
}

void SoftSampler::trace_pixels(const Job& job, std::size_t first, std::size_t last) const {
  ao::EmbreeQuery query(ao::EmbreeQuery::coherent);
  ReceiverPacket from;
  RayPacket16 packet;
  const std::size_t stride = std::max(samples_.per_pattern, lanes);
  for (std::size_t i = first; i < last; ++i) {
    if (!job.wants(i)) continue;
    job.irradiance[i] = 0;
    if (idle(job.receivers[i])) continue;
    for (std::size_t lane = 0; lane < lanes; ++lane) put(from, lane, job.receivers[i]);
    start_rays(from, packet);
    from = aimed_from(from);
    const std::size_t pattern = scattered(i) % samples_.pattern_count * stride;
    alignas(64) float sums[lanes] = {};
    for (std::size_t s = pattern; s < pattern + samples_.per_pattern; s += lanes) {
      if (!aim(from, s, packet)) continue;
      for (std::size_t lane = samples_.per_pattern; lane < lanes; ++lane) {  // fewer points than lanes
        packet.valid[lane] = 0;
        packet.weight[lane] = 0;
      }
      query.occluded16(packet.valid, job.casters, packet.rays);
      kernels_.gather(packet, sums);
    }
    float sum = 0;
    for (const float s : sums) sum += s;
    job.irradiance[i] = sum * area_of_a_ray_;
  }
}

void SoftSampler::trace_tiles(const Job& job, std::size_t first, std::size_t last) const {
  ao::EmbreeQuery query(ao::EmbreeQuery::coherent);
  RayPacket16 packet;
  const std::size_t columns = (job.width + tile_side - 1) / tile_side;
  for (std::size_t tile = first; tile < last; ++tile) {
    const std::size_t x0 = tile % columns * tile_side, y0 = tile / columns * tile_side;
    ReceiverPacket from{};
    std::size_t pixels[lanes];
    bool any = false;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t x = x0 + lane % tile_side, y = y0 + lane / tile_side;
      pixels[lane] = x < job.width && y < job.height && job.wants(y * job.width + x) ? y * job.width + x
                                                                                     : job.receivers.size();
      if (pixels[lane] == job.receivers.size()) continue;
      put(from, lane, job.receivers[pixels[lane]]);
      any |= !idle(job.receivers[pixels[lane]]);
    }
    start_rays(from, packet);
    from = aimed_from(from);
    const std::size_t block = scattered(tile) % (samples_.pattern_count / lanes) * samples_.per_pattern;
    alignas(64) float sums[lanes] = {};
    for (std::size_t cell = block; any && cell < block + samples_.per_pattern; ++cell) {
      const std::size_t s = cell * lanes;
      if (!aim(from, s, packet)) continue;
      query.occluded16(packet.valid, job.casters, packet.rays);
      kernels_.gather(packet, sums);
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (pixels[lane] != job.receivers.size()) job.irradiance[pixels[lane]] = sums[lane] * area_of_a_ray_;
    }
  }
}

}  // namespace tenebra::bench
