// A light with an area: a planar convex polygon that shines to one side, uniform and diffuse.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra {

/// World space. The vertices are floats, taken as exact; the light's plane and frame are derived from them in
/// double, with the same operations on every machine.
struct AreaLight {
  std::vector<glm::vec3> vertices;  ///< 3 to 14, convex, counter-clockwise seen from where it shines
  glm::dvec3 centre{0.0};           ///< centroid of the polygon's area; origin of the frame below
  glm::dvec3 ex{1, 0, 0};           ///< unit; with ey and normal a right-handed frame
  glm::dvec3 ey{0, 1, 0};           ///< unit
  glm::dvec3 normal{0, 0, 1};       ///< unit, the side that shines
  std::vector<glm::dvec2> outline;  ///< the vertices in (ex, ey), metres: the polygon that is computed with
  double area_m2 = 0;               ///< of the outline
};

/// Checks and completes a light: 3 to 14 finite vertices, planar up to the rounding of their coordinates,
/// convex, not self-crossing, with an area. Collinear and repeated vertices are dropped. The error says which
/// vertex breaks which rule and by how much.
Expected<AreaLight> make_area_light(std::span<const glm::vec3> vertices);

/// centre +- half_x +- half_y, shining along cross(half_x, half_y).
Expected<AreaLight> make_rectangle_light(glm::vec3 centre, glm::vec3 half_x, glm::vec3 half_y);
/// The regular 12-gon with the disc's area, so that its flux is the disc's.
Expected<AreaLight> make_disc_light(glm::vec3 centre, glm::vec3 half_x, glm::vec3 half_y);

}  // namespace tenebra
