// What the tests of groups and shafts start from: triangles, points on them and an area light.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "soft/area_light.h"
#include "soft/point_groups.h"
#include "support/samples.h"
#include "support/soup.h"

namespace tenebra::testing {

struct SoftCase {
  std::string name;  ///< printed with a failure
  Soup soup;
  ViewRays view;
  VisiblePoints points;
  AreaLight light;
};

/// A regular polygon of `sides` corners around `centre` that shines along `normal`.
inline AreaLight regular_light(glm::dvec3 centre, glm::dvec3 normal, double radius, int sides) {
  AreaLight light;
  light.centre = centre;
  light.normal = glm::normalize(normal);
  const glm::dvec3 other = std::abs(light.normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  light.ex = glm::normalize(glm::cross(other, light.normal));
  light.ey = glm::cross(light.normal, light.ex);
  for (int k = 0; k < sides; ++k) {
    const double angle = 6.283185307179586 * k / sides;
    light.outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    light.vertices.emplace_back(centre + light.outline.back().x * light.ex +
                                light.outline.back().y * light.ey);
  }
  light.area_m2 = 0.5 * sides * radius * radius * std::sin(6.283185307179586 / sides);
  return light;
}

inline glm::dvec3 light_point(const AreaLight& light, glm::dvec2 at) {
  return light.centre + at.x * light.ex + at.y * light.ey;
}

/// Somewhere on the light: a vertex, a point of an edge, the centre or inside.
inline glm::dvec3 random_light_point(const AreaLight& light, Random& random) {
  const auto count = static_cast<std::uint32_t>(light.outline.size());
  const std::uint32_t k = random.index(count);
  const glm::dvec2 a = light.outline[k], b = light.outline[(k + 1) % count];
  switch (random.index(4)) {
    case 0:
      return light_point(light, a);
    case 1:
      return light_point(light, a + random.unit() * (b - a));
    case 2:
      return light_point(light, random.unit() * a);
    default:
      return light_point(light, random.unit() * (a + random.unit() * (b - a)));
  }
}

inline double theta_of(const TriangleView& triangles, std::uint32_t occluder, std::uint32_t receiver) {
  const Corners t = corners_of(triangles, occluder), r = corners_of(triangles, receiver);
  return contact_threshold(t.v, rounding_tolerance(t.v), rounding_tolerance(r.v));
}

}  // namespace tenebra::testing
