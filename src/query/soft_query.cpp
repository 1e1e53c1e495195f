// Soft shadows of points. A point that does not say on which side of its triangle it is is on that of the
// light's centre.
#include "points/triangle_corners.h"
#include "query/tracer_state.h"

namespace tenebra {
namespace {

using glm::dvec3;

constexpr std::size_t most_corners = 254;

/// The side of a triangle that the light's centre is on; 1 if on neither.
int side_of_centre(const AreaLight& light, const TriangleView& triangles, std::uint32_t triangle) {
  const dvec3 corner(points::corners_of(triangles, triangle).v[0]);
  const dvec3 way = light.at_infinity ? light.centre : light.centre - corner;
  return glm::dot(query::face_normal(triangles, triangle), way) < 0 ? -1 : 1;
}

/// A point's shading normal, for calls in which some points have one.
glm::vec3 shading_normal(const QueryPoints& points, std::size_t point, const AreaLight& light,
                         const TriangleView& triangles) {
  const dvec3 normal(query::normal_of(points, point));
  if (normal != dvec3(0.0)) return glm::vec3(glm::normalize(normal));
  const std::uint32_t triangle = query::triangle_of(points, point);
  if (triangle == no_triangle) return glm::vec3(-light.normal);
  const dvec3 face = query::face_normal(triangles, triangle);
  int side = query::said_side(points, point, triangles);
  if (side == 0) side = side_of_centre(light, triangles, triangle);
  return glm::vec3(face * static_cast<double>(side));
}

}  // namespace

Expected<void> PointTracer::soft_visibility(const Geometry& geometry, const QueryPoints& points,
                                            const AreaLight& light, const SoftShadowConfig& config,
                                            std::span<float> visible_fraction, std::span<float> irradiance,
                                            const StopFlag* stop, const QueryProgress& progress) {
  const parallel::FloatEnvironment ieee;
  query::TracerState& s = *state_;
  const std::size_t count = points.positions.size();
  for (const std::span<float>& out : {visible_fraction, irradiance})
    if (!out.empty() && out.size() != count)
      return base::fail(
          "soft visibility: found room for {} values, expected one for each of {} points, or none",
          out.size(), count);
  const std::size_t corners = light.polygon.size();
  if (corners < 3 || corners > most_corners || (!light.at_infinity && light.vertices.size() != corners))
    return base::fail("light: found {} vertices, expected one made by make_area_light or make_sun",
                      light.at_infinity ? corners : light.vertices.size());
  if (!(config.error_255 >= 0))
    return base::fail("soft visibility: an error of {}/255, expected 0 or more", config.error_255);
  if (auto checked = query::check_points(points, *geometry.data_); !checked) return checked;
  s.follow(geometry.data_);

  return query::in_portions(points, stop, progress, [&](const query::Portion& portion) -> Expected<void> {
    const TriangleView triangles = s.triangles();
    s.begin(points, portion);
    s.normals.assign(points.normals.empty() ? 0 : portion.pixels(), glm::vec3(0.0f));
    query::each_point(portion, [&](std::size_t i, std::size_t pixel) {
      const std::size_t point = portion.first() + i;
      const std::uint32_t triangle = query::triangle_of(points, point);
      if (!s.normals.empty()) s.normals[pixel] = shading_normal(points, point, light, triangles);
      if (triangle != no_triangle) {
        const int side = query::said_side(points, point, triangles);
        s.seen.triangles[pixel] = triangle;
        s.seen.sides[pixel] =
            static_cast<std::int8_t>(side != 0 ? side : side_of_centre(light, triangles, triangle));
        return;
      }
      s.seen.triangles[pixel] = free_point;
      s.seen.sides[pixel] = query::normal_of(points, point) != glm::vec3(0.0f) ? 1 : 0;
    });
    if (!s.soft.trace(s.seen, s.normals, triangles, light, config, s.visible, stop)) {
      if (s.soft.refusal().empty()) return base::stopped();
      return base::fail(ErrorKind::memory, "{}", s.soft.refusal());
    }
    query::each_point(portion, [&](std::size_t i, std::size_t pixel) {
      if (!visible_fraction.empty())
        visible_fraction[portion.first() + i] = s.visible.visible_fraction[pixel];
      if (!irradiance.empty()) irradiance[portion.first() + i] = s.visible.irradiance[pixel];
    });
    return {};
  });
}

}  // namespace tenebra
