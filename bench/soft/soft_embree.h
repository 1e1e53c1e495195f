// The contestant: soft shadows by Embree's shadow rays to stratified points of the light.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bench/common/bench_embree.h"
#include "bench/common/bench_frame.h"
#include "bench/common/light_samples.h"
#include "bench/common/packet_kernels.h"

namespace tenebra::bench {

/// Which rays Embree gets together, sixteen at a time.
enum class Packing {
  pixel,  ///< sixteen points of the light, one visible point
  tile,   ///< one cell of the light, a tile of 4x4 visible points
};
const char* packing_name(Packing packing);

/// One per pixel: where its rays start. What all sampling contestants are given.
struct SampledReceiver {
  glm::vec3 position;          ///< lifted off the triangle by `lift_of_diagonal` of the scene's diagonal
  glm::vec3 normal;            ///< shading; zero: no rays
  glm::vec3 geometric_normal;  ///< unit, on the side that is seen
};
/// The least that keeps float rays off their own triangles (a few float roundings of the scene's size): more
/// would have Embree miss contacts. 2e-5 leaves an RMSE of 3.7/255 at robots 100 however many rays are traced
/// (museum5 20: 0.56, museum5x64 20: 1.3), 2e-7 leaves 0.22 (0.07, 0.08) at 2,048 rays, most of it noise.
inline constexpr float lift_of_diagonal = 2e-7f;
std::vector<SampledReceiver> sampled_receivers(const BenchFrame& frame);
void put(ReceiverPacket& packet, std::size_t lane, const SampledReceiver& receiver);
/// Origins of rays that kernels aim: from the receivers on, unmasked.
void start_rays(const ReceiverPacket& from, RayPacket16& out);

/// Stratified shadow rays to one light, a fixed number per pixel.
class SoftSampler {
public:
  /// `rays`: a power of two. Patterns are drawn here, not when tracing.
  SoftSampler(const AreaLight& light, std::size_t rays, Packing packing);

  /// Irradiance for radiance 1 of the pixels where `wanted` is not 0 (empty: all) into `irradiance`, which
  /// keeps its values elsewhere. Pixels that are not seen, or that do not face the light, get 0. On all
  /// threads; the same bits for any number of them.
  void trace(const EmbreeScene& casters, std::span<const SampledReceiver> receivers, int width, int height,
             std::span<const std::uint8_t> wanted, std::span<float> irradiance) const;

private:
  struct Job;
  ReceiverPacket aimed_from(const ReceiverPacket& from) const;
  bool aim(const ReceiverPacket& from, std::size_t sample, RayPacket16& out) const;
  void trace_pixels(const Job& job, std::size_t first, std::size_t last) const;
  void trace_tiles(const Job& job, std::size_t first, std::size_t last) const;

  LightSamples samples_;
  Packing packing_;
  glm::vec3 normal_;
  float area_of_a_ray_ = 0;
  /// Of a sun: its points are directions from wherever a ray starts, and nothing is behind it.
  bool endless_ = false;
  PacketKernels kernels_;
};

}  // namespace tenebra::bench
