// A light with an area: a planar convex polygon that shines to one side, uniform and diffuse; or the disc of
// a sun, which has no place and is seen in the same directions from every point.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra {

/// In world space; made by the functions below. The vertices are floats, taken as exact. The light's plane
/// and frame are derived from them in double, with the same operations on every machine.
struct AreaLight {
  std::vector<glm::vec3> vertices;  ///< 3 to 14, convex, counter-clockwise seen from the lit side
  glm::dvec3 centre{0.0};           ///< centroid of the polygon's area; origin of the frame below
  glm::dvec3 ex{1, 0, 0};           ///< unit; with ey and normal a right-handed frame
  glm::dvec3 ey{0, 1, 0};           ///< unit
  glm::dvec3 normal{0, 0, 1};       ///< unit, towards the lit side
  std::vector<glm::dvec2> polygon;  ///< the vertices in (ex, ey), metres: what the solvers compute with
  double area_m2 = 0;  ///< of the polygon; for a sun the irradiance at radiance 1 on a surface facing it
  /// A sun. From every point p it is seen where the polygon would be at p + centre, but as if from infinitely
  /// far: whatever stands on these lines hides it, at any distance. So `centre` is the unit vector towards it
  /// and the polygon has no unit. No vertices.
  bool at_infinity = false;
};

/// Makes a light from a polygon: 3 to 14 finite vertices, in a plane up to the rounding of their coordinates,
/// convex, not crossing itself, with an area. Collinear and repeated vertices are dropped. If a rule is
/// broken, the error says which rule, at which vertex, and by how much.
Expected<AreaLight> make_area_light(std::span<const glm::vec3> vertices);

/// A rectangle with the corners centre +- half_x +- half_y, shining along cross(half_x, half_y).
Expected<AreaLight> make_rectangle_light(glm::vec3 centre, glm::vec3 half_x, glm::vec3 half_y);
/// A disc, as the regular 12-gon of the same area, so that it sends the same amount of light.
Expected<AreaLight> make_disc_light(glm::vec3 centre, glm::vec3 half_x, glm::vec3 half_y);
/// A sun in the direction `to_sun` (any length but zero), from 1e-6 to 90 degrees wide: the regular 12-gon
/// with the area that the disc has on a plane across its middle. The part that a straight edge hides differs
/// by at most 0.08 % (0.2/255) from the part that it hides of the disc, wherever it lies.
Expected<AreaLight> make_sun(glm::vec3 to_sun, double diameter_deg);

}  // namespace tenebra
