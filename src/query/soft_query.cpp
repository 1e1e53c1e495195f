// Soft shadows of points. A tracer sees triangles from an eye; here each point says on which side of its
// triangle it is. So the eye is a vertex of the light that is on that side: the light's first, and for the
// few points whose planes cut the light the next suitable one, in a pass of its own. A light without such a
// vertex is below the point's horizon. The vertices of a sun are directions, so its eyes are infinitely far.
#include "points/triangle_corners.h"
#include "query/tracer_state.h"

namespace tenebra {
namespace {

using glm::dvec3;

constexpr std::uint8_t no_eye = 0xff;

/// The views from the light's vertices.
void find_eyes(const AreaLight& light, std::vector<ViewRays>& eyes) {
  eyes.assign(light.polygon.size(), {});
  for (std::size_t k = 0; k < eyes.size(); ++k) {
    const glm::dvec2 at = light.polygon[k];
    if (light.at_infinity)
      eyes[k] = {.d0 = -glm::vec3(light.centre + at.x * light.ex + at.y * light.ey), .orthographic = true};
    else
      eyes[k].eye = light.vertices[k];
  }
}

/// The side of a triangle that the light's centre is on; 1 if on neither.
int side_of_centre(const AreaLight& light, const TriangleView& triangles, std::uint32_t triangle) {
  const dvec3 corner(points::corners_of(triangles, triangle).v[0]);
  const dvec3 way = light.at_infinity ? light.centre : light.centre - corner;
  return glm::dot(query::face_normal(triangles, triangle), way) < 0 ? -1 : 1;
}

/// The first eye on `side` of a triangle; side 0: that of the light's centre.
std::uint8_t eye_on(const AreaLight& light, const std::vector<ViewRays>& eyes, const TriangleView& triangles,
                    std::uint32_t triangle, int side) {
  if (side == 0) side = side_of_centre(light, triangles, triangle);
  const points::Corners corners = points::corners_of(triangles, triangle);
  for (std::size_t k = 0; k < eyes.size(); ++k)
    if (points::eye_side(corners.v, eyes[k]) == side) return static_cast<std::uint8_t>(k);
  return no_eye;
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
  if (corners < 3 || corners >= no_eye || (!light.at_infinity && light.vertices.size() != corners))
    return base::fail("light: found {} vertices, expected one made by make_area_light or make_sun",
                      light.at_infinity ? corners : light.vertices.size());
  if (!(config.error_255 >= 0))
    return base::fail("soft visibility: an error of {}/255, expected 0 or more", config.error_255);
  if (auto checked = query::check_points(points, *geometry.data_); !checked) return checked;
  s.follow(geometry.data_);
  const bool some_apart = query::need_stand_ins(points);
  const std::vector<ViewRays>& eyes = s.light_eyes;
  find_eyes(light, s.light_eyes);

  return query::in_portions(points, stop, progress, [&](const query::Portion& portion) -> Expected<void> {
    if (some_apart && !s.stand_ins.follow(geometry.data_, portion.count(), stop)) return base::stopped();
    const TriangleView triangles = s.triangles(some_apart);
    s.begin(points, portion);
    s.eyes.assign(portion.count(), no_eye);
    s.normals.assign(points.normals.empty() ? 0 : portion.pixels(), glm::vec3(0.0f));
    query::each_point(portion, [&](std::size_t i, std::size_t pixel) {
      const std::size_t point = portion.first() + i;
      const std::uint32_t triangle = query::triangle_of(points, point);
      if (!s.normals.empty()) s.normals[pixel] = shading_normal(points, point, light, triangles);
      if (triangle != no_triangle) {
        s.eyes[i] = eye_on(light, eyes, triangles, triangle, query::said_side(points, point, triangles));
        return;
      }
      const dvec3 normal(query::normal_of(points, point));
      const bool faces = normal != dvec3(0.0);
      s.stand_ins.set(i, points.positions[point], faces ? normal : -light.normal,
                      faces ? query::StandAt::point : query::StandAt::behind);
      s.eyes[i] = eye_on(light, eyes, triangles, s.stand_ins.id(i), 1);
    });
    for (std::size_t k = 0; k < eyes.size(); ++k) {
      const auto eye = static_cast<std::uint8_t>(k);
      if (k > 0 && std::find(s.eyes.begin(), s.eyes.end(), eye) == s.eyes.end()) continue;
      query::each_point(portion, [&](std::size_t i, std::size_t pixel) {
        const std::uint32_t own = query::triangle_of(points, portion.first() + i);
        const std::uint32_t triangle = own == no_triangle ? s.stand_ins.id(i) : own;
        s.seen.triangles[pixel] = s.eyes[i] == eye ? triangle : no_triangle;
      });
      if (!s.soft.trace(s.seen, s.normals, eyes[k], triangles, light, config, s.visible, stop)) {
        if (s.soft.refusal().empty()) return base::stopped();
        return base::fail(ErrorKind::memory, "{}", s.soft.refusal());
      }
      query::each_point(portion, [&](std::size_t i, std::size_t pixel) {
        if (s.eyes[i] != eye && !(k == 0 && s.eyes[i] == no_eye)) return;
        if (!visible_fraction.empty())
          visible_fraction[portion.first() + i] = s.visible.visible_fraction[pixel];
        if (!irradiance.empty()) irradiance[portion.first() + i] = s.visible.irradiance[pixel];
      });
    }
    return {};
  });
}

}  // namespace tenebra
