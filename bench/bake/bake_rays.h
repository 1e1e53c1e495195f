// The contestant: light of texels by Embree's shadow rays to stratified points of an area light.
#pragma once

#include <span>
#include <vector>

#include <tenebra/frame_geometry.h>
#include "bake/sample.h"
#include "bench/soft/soft_embree.h"

namespace tenebra::bench {

/// How a texel's value is found from its rays.
enum class RaySum {
  plain,  ///< the light that they bring
  scaled  ///< the part of them that arrives, times what the light gives with nothing in its way
};
const char* ray_sum_name(RaySum sum);

/// Where the rays of bake samples start: on the side of the samples' shading normals, lifted by `lift_m`.
std::vector<SampledReceiver> texel_receivers(const FrameGeometry& geometry,
                                             std::span<const bake::Sample> samples, float lift_m);

/// Irradiance for radiance 1 with nothing in the way, in float: the contour integral over the part of the
/// polygon above the receiver's plane.
float open_irradiance(const AreaLight& light, const SampledReceiver& receiver);

/// A fixed number of rays per texel.
class BakeRays {
public:
  /// `rays`: a power of two. Patterns are drawn here, not when tracing.
  BakeRays(const AreaLight& light, std::size_t rays, Packing packing, RaySum sum);

  /// Irradiance for radiance 1 of each receiver. On all threads; the same bits for any number of them.
  /// Receivers that follow each other should be close together.
  void trace(const EmbreeScene& casters, std::span<const SampledReceiver> receivers,
             std::span<float> irradiance) const;

private:
  struct Sums;
  void trace_texel(RTCScene casters, const SampledReceiver& receiver, std::size_t number, Sums& sums) const;
  void trace_sixteen(RTCScene casters, std::span<const SampledReceiver> receivers, std::size_t number,
                     Sums& sums) const;
  float light_of(const SampledReceiver& receiver, float seen, float all) const;

  const AreaLight& light_;
  LightSamples samples_;
  Packing packing_;
  RaySum sum_;
  glm::vec3 normal_;
  float area_of_a_ray_ = 0;
  PacketKernels kernels_;
};

}  // namespace tenebra::bench
