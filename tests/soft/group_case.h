// What the tests of groups and shafts start from: triangles, points on them and an area light.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <tenebra/area_light.h>
#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "soft/groups/point_groups.h"
#include "support/samples.h"
#include "support/soup.h"

namespace tenebra::testing {

struct GroupCase {
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
    light.polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    light.vertices.emplace_back(centre + light.polygon.back().x * light.ex +
                                light.polygon.back().y * light.ey);
  }
  light.area_m2 = 0.5 * sides * radius * radius * std::sin(6.283185307179586 / sides);
  return light;
}

inline glm::dvec3 light_point(const AreaLight& light, glm::dvec2 at) {
  return light.centre + at.x * light.ex + at.y * light.ey;
}

/// Somewhere on the light: a vertex, a point of an edge, the centre or inside.
inline glm::dvec3 random_light_point(const AreaLight& light, Random& random) {
  const auto count = static_cast<std::uint32_t>(light.polygon.size());
  const std::uint32_t k = random.index(count);
  const glm::dvec2 a = light.polygon[k], b = light.polygon[(k + 1) % count];
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
  const points::Corners t = points::corners_of(triangles, occluder),
                        r = points::corners_of(triangles, receiver);
  return points::contact_threshold(t.v, points::rounding_tolerance(t.v), points::rounding_tolerance(r.v));
}

/// A light somewhere about the soup: beside or inside it, facing its middle or anywhere, tiny to huge.
inline AreaLight random_light(const Soup& soup, Random& random) {
  const glm::dvec3 middle = 0.5 * (soup.low() + soup.high()), half = 0.5 * (soup.high() - soup.low());
  const double size = glm::length(half);
  const glm::dvec3 centre = middle + half * random.in_cube(random.chance(0.5) ? 1.0 : 2.0);
  const glm::dvec3 normal = random.chance(0.7) ? middle - centre : random.direction();
  const double radius = size * (random.chance(0.8) ? random.in(0.02, 0.3) : std::pow(10.0, random.in(-9, 1)));
  return regular_light(centre, glm::length(normal) > 0 ? normal : glm::dvec3(0, 1, 0), radius,
                       3 + static_cast<int>(random.index(12)));
}

/// A light in the plane of a triangle of the soup, around one of its corners.
inline AreaLight light_in_plane(const Soup& soup, Random& random) {
  const auto id = random.index(static_cast<std::uint32_t>(soup.triangles.size()));
  const glm::dvec3 a(soup.corner(id, 0)), b(soup.corner(id, 1)), c(soup.corner(id, 2));
  const glm::dvec3 n = glm::cross(b - a, c - a);
  if (!(glm::length(n) > 0)) return random_light(soup, random);
  return regular_light(a, random.chance(0.5) ? n : -n, 0.3 * glm::length(b - a), 4);
}

/// Points of a view, points anywhere on the triangles, or points behind edges as a corner of the light sees
/// them; seen from the light or from anywhere.
inline GroupCase random_case(std::string name, Soup soup, AreaLight light, Random& random) {
  GroupCase c{std::move(name), std::move(soup), {}, {}, std::move(light)};
  ShadowLight at;
  at.position = glm::vec3(c.light.centre);
  c.view = view_from_light(at);
  const glm::dvec3 middle = 0.5 * (c.soup.low() + c.soup.high()), size = c.soup.high() - c.soup.low();
  if (random.chance(0.5)) c.view = pinhole(middle + size * random.in_cube(1), middle, 0.7, 24, 24);
  at.position = c.light.vertices[random.index(static_cast<std::uint32_t>(c.light.vertices.size()))];
  switch (random.index(3)) {
    case 0:
      c.points = points_on_triangles(c.soup, random, 150);
      break;
    case 1:
      c.points = points_behind_edges(c.soup, at, random, 150);
      break;
    default:
      c.points = view_samples(c.soup.view(), c.view, 24, 24);
  }
  return c;
}

}  // namespace tenebra::testing
