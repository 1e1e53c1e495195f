// Points of a shape's surface, and how far off it rays start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "ao/objects/scene_objects.h"

namespace tenebra::ao {

struct SurfacePoint {
  std::uint32_t triangle = 0;
  float v = 0, w = 0;  ///< barycentric weights of the second and third corner
  bool front = true;   ///< seen from where the triangle runs counter-clockwise
};

/// Unit; zero without an area.
glm::vec3 face_normal(const ObjectShape& shape, std::size_t triangle);

double largest_coordinate(const ObjectShape& shape);
/// How far off a surface rays start: beyond the rounding to float of the point, and of the corners of two
/// triangles that touch (each at most sqrt(3)/2 ulp of its largest coordinate; as much again for the sums).
float surface_lift(double largest_coordinate);

}  // namespace tenebra::ao
