#include "ao/receivers/point_rays.h"

#include <algorithm>

namespace tenebra::ao {

void PointRays::begin_frame(const SceneObjects& objects, int rays, double reach, const RayKernels& kernels) {
  objects_ = &objects;
  if (pattern_.rays != rays) pattern_ = make_ray_pattern(rays);
  reach_ = reach;
  kernels_ = kernels;
  lift_ = surface_lift(largest_coordinate(objects.standing));
}

void PointRays::spread(const Receiver& receiver, trees::RayBatch* out) const {
  constexpr double cell = 1.0 / 256;  // of the reach: in each cell rays are turned by another angle
  const glm::dvec3 size = glm::abs(receiver.position);
  const float off = std::max(lift_, surface_lift(std::max({size.x, size.y, size.z})));
  const double scale = receiver.owner.object >= 0
                           ? objects_->objects[static_cast<std::size_t>(receiver.owner.object)].scale
                           : 1.0;
  kernels_.fan.spread(pattern_, turned_axes(receiver.normal, receiver.local * scale, cell * reach_),
                      receiver.face, glm::vec3(receiver.position + double{off} * glm::dvec3(receiver.face)),
                      out);
}

float PointRays::hidden(const float* distances) const {
  const float sum = kernels_.fan.fall_off(distances, static_cast<int>(pattern_.batches.size()), reach());
  return std::clamp(sum / static_cast<float>(pattern_.rays), 0.0f, 1.0f);
}

}  // namespace tenebra::ao
