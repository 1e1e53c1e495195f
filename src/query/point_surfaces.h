// The surface at query points: the side that a point is on, and its normal; and checks of the points.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include <tenebra/queries.h>
#include "query/geometry_data.h"

namespace tenebra::query {

/// Fails with a sentence on the first point, in their order, that breaks a rule of QueryPoints.
Expected<void> check_points(const QueryPoints& points, const GeometryData& geometry);

inline std::uint32_t triangle_of(const QueryPoints& points, std::size_t i) {
  return points.triangles.empty() ? no_triangle : points.triangles[i];
}
/// Whether some points lie on no triangle.
bool some_free(const QueryPoints& points);
/// The normal that was given, of any length; zero: none.
inline glm::vec3 normal_of(const QueryPoints& points, std::size_t i) {
  return points.normals.empty() ? glm::vec3(0.0f) : points.normals[i];
}
/// Unit, on the counter-clockwise side; zero where the triangle has no area.
glm::dvec3 face_normal(const TriangleView& triangles, std::uint32_t triangle);

/// The side of its triangle that a point was said to be on: 1, -1, or 0: not given.
int said_side(const QueryPoints& points, std::size_t i, const TriangleView& triangles);

}  // namespace tenebra::query
