// What see-through triangles hide of the ambient light: as much as opaque ones times (1 - T), T the mean over
// channels of their material's transmittance, textures by their mean. Receivers' rays meet them separately
// from everything else, each share of opacity by itself, and the results are multiplied, as if they hid
// independently of opaque triangles and of each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/scene.h>
#include <tenebra/stop_flag.h>
#include "ao/cast/ray_kernels.h"
#include "ao/receivers/point_rays.h"
#include "ao/receivers/receiver_sets.h"
#include "math/box.h"

namespace tenebra::ao {

class SeeThroughCasters {
public:
  /// The instant of `geometry`. Of no use if `stop` was requested.
  void begin_frame(const Scene& scene, const FrameGeometry& geometry, const StopFlag* stop);
  bool empty() const { return layers_.empty(); }

  /// Multiplies the values of receivers by the share of their light that passes.
  void darken(const ReceiverSet& set, const PointRays& rays, const RayKernels& kernels,
              std::span<float> values, std::uint64_t& rays_cast, const StopFlag* stop) const;

  /// The share of a point's light that passes, 0..1, by its rays: `count` of them, in batches. Overwrites
  /// `distances`, one for each.
  float left(const glm::dvec3& point, std::span<const trees::RayBatch> rays, int count, float reach,
             const RayKernels& kernels, std::span<float> distances, std::uint64_t& rays_cast) const;

private:
  static constexpr int opacity_steps = 64;  ///< 1 - T is rounded to one of these

  struct Layer {
    float opacity = 0;
    math::Box<double> box;
    trees::TriangleBvh triangles;
  };
  void add_layer(int step, const std::vector<glm::uvec3>& triangles, const FrameGeometry& geometry,
                 const StopFlag* stop);

  std::vector<Layer> layers_;  ///< one for each opacity
};

}  // namespace tenebra::ao
