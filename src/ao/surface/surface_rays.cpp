#include "ao/surface/surface_rays.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "ao/cast/sphere_maps.h"

namespace tenebra::ao {
namespace {

using glm::dvec3;
using glm::vec3;

/// Sixteen directions all around, three degrees above the surface: they see what is low.
RayPattern grazing_pattern() {
  constexpr double up = 0.0524, around = 2 * std::numbers::pi / trees::batch_size;
  RayPattern pattern;
  pattern.rays = trees::batch_size;
  pattern.batches.resize(1);
  for (int i = 0; i < trees::batch_size; ++i) {
    pattern.batches[0].x[i] = static_cast<float>(std::sqrt(1 - up * up) * std::cos(i * around));
    pattern.batches[0].y[i] = static_cast<float>(std::sqrt(1 - up * up) * std::sin(i * around));
    pattern.batches[0].z[i] = static_cast<float>(up);
  }
  return pattern;
}

}  // namespace

SurfaceRays::SurfaceRays(const ObjectShape& shape, const trees::TriangleBvh& casters, double reach)
    : shape_(shape),
      casters_(casters),
      reach_(static_cast<float>(reach)),
      lift_(surface_lift(largest_coordinate(shape))),
      pattern_(make_ray_pattern(rays)),
      grazing_(grazing_pattern()) {}

SurfaceRays::Seen SurfaceRays::look(const SurfacePoint& point, const RayKernels& kernels) const {
  constexpr int batches = rays / trees::batch_size;
  const glm::uvec3 t = shape_.triangles[point.triangle];
  vec3 face = face_normal(shape_, point.triangle);
  if (face == vec3(0.0f)) return {.nearest = reach_};
  if (!point.front) face = -face;
  const float u = 1 - point.v - point.w;
  vec3 normal = u * shape_.normals[t.x] + point.v * shape_.normals[t.y] + point.w * shape_.normals[t.z];
  const float square = glm::dot(normal, normal);
  normal = square > 1e-12f ? normal / std::sqrt(square) : face;
  if (glm::dot(normal, face) < 0) normal = -normal;
  const dvec3 p = double{u} * dvec3(shape_.positions[t.x]) + double{point.v} * dvec3(shape_.positions[t.y]) +
                  double{point.w} * dvec3(shape_.positions[t.z]);
  const vec3 origin(p + double{lift_} * dvec3(face));
  trees::RayBatch fan[batches + 1];
  alignas(64) float distances[(batches + 1) * trees::batch_size], facing[(batches + 1) * trees::batch_size];
  const Frame frame = frame_around(normal), flat = frame_around(face);
  kernels.fan.spread(pattern_, {frame.x, frame.y, normal}, face, origin, fan);
  kernels.fan.spread(grazing_, {flat.x, flat.y, face}, face, origin, fan + batches);
  std::fill(std::begin(distances), std::end(distances), reach_);
  kernels.cast(casters_, {fan, batches + 1}, distances, facing);
  Seen seen;
  seen.occlusion = std::clamp(kernels.fan.fall_off(distances, batches, reach_) / rays, 0.0f, 1.0f);
  seen.nearest = *std::min_element(std::begin(distances), std::end(distances));
  seen.buried = 2 * std::count_if(facing, facing + rays, [](float f) { return f < 0; }) > rays;
  return seen;
}

}  // namespace tenebra::ao
