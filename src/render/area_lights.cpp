#include "render/area_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "points/contact_rule.h"

namespace tenebra::render {

namespace {

using glm::dvec3;
using glm::vec3;

/// Half axes of a rectangle that shines along `direction`; the first is level, or at right angles to z where
/// `direction` is nearly vertical.
void rectangle_axes(const dvec3& direction, glm::dvec2 size_m, vec3& half_x, vec3& half_y) {
  const bool upright = std::abs(direction.y) > 0.999 * glm::length(direction);
  const dvec3 x = glm::normalize(glm::cross(upright ? dvec3(0, 0, -1) : dvec3(0, 1, 0), direction));
  const dvec3 y = glm::normalize(glm::cross(direction, x));
  half_x = vec3(0.5 * size_m.x * x);
  half_y = vec3(0.5 * size_m.y * y);
}

dvec3 facing_direction(const Light& light, const WorldLight& placed, const AreaLightSettings& settings,
                       const math::Box<double>& box) {
  if (!settings.facing && light.type == LightType::spot) return placed.direction;
  const dvec3 direction = dvec3(settings.facing.value_or(vec3(box.centre()))) - dvec3(placed.position);
  return glm::dot(direction, direction) > 0 ? direction : dvec3(0, -1, 0);
}

/// Width and height that the settings give point light `light`.
glm::dvec2 point_size_m(int light, const AreaLightSettings& settings, const math::Box<double>& box) {
  const auto index = static_cast<std::size_t>(light);
  if (index < settings.own_size_m.size() && settings.own_size_m[index]) return *settings.own_size_m[index];
  const double percent_m = 0.01 * box.diagonal();
  if (settings.size == glm::vec2(0.0f)) return glm::dvec2(percent_m * settings.unsized_percent);
  return (settings.percent_of_diagonal ? percent_m : 1.0) * glm::dvec2(settings.size);
}

/// Degrees: the light's own setting, else the one for all lights, else the scene's.
float sun_diameter(const Light& light, int number, const AreaLightSettings& settings) {
  const auto index = static_cast<std::size_t>(number);
  if (index < settings.own_sun_deg.size() && settings.own_sun_deg[index]) return *settings.own_sun_deg[index];
  const float of_scene = light.diameter_deg > 0 ? light.diameter_deg : settings.unsized_sun_deg;
  return settings.sun_deg.value_or(of_scene);
}

Expected<AreaLight> rectangle_of_point(const Light& light, const WorldLight& placed,
                                       const AreaLightSettings& settings, const math::Box<double>& box) {
  vec3 half_x, half_y;
  rectangle_axes(facing_direction(light, placed, settings, box), point_size_m(placed.light, settings, box),
                 half_x, half_y);
  return make_rectangle_light(placed.position, half_x, half_y);
}

/// The file's own rectangle or disc; its first axis is turned where the two would make it shine the wrong
/// way.
Expected<AreaLight> placed_polygon(const Light& light, const WorldLight& placed) {
  const bool turned = glm::dot(glm::cross(placed.axis_x, placed.axis_y), placed.direction) < 0;
  const vec3 half_x = turned ? -placed.axis_x : placed.axis_x;
  return light.type == LightType::area_disk ? make_disc_light(placed.position, half_x, placed.axis_y)
                                            : make_rectangle_light(placed.position, half_x, placed.axis_y);
}

/// Distance up to which a vertex counts as in the light's plane but for the vertex's own rounding. The
/// light's vertices are rounded sums of a rounded centre and two rounded half axes: off by 2 tau each; the
/// plane through them is off by at most as much again within their reach.
double plane_tolerance(const AreaLight& light) {
  vec3 far(0.0f);
  for (const vec3& v : light.vertices) far = glm::max(far, glm::abs(v));
  const vec3 thrice[3] = {far, far, far};
  return 4 * points::rounding_tolerance(thrice);
}

bool within(const AreaLight& light, const vec3 corners[3], double light_tolerance) {
  if (light.at_infinity) return false;
  const double tolerance = light_tolerance + points::rounding_tolerance(corners);
  for (int k = 0; k < 3; ++k) {
    if (!(std::abs(glm::dot(light.normal, dvec3(corners[k]) - light.centre)) <= tolerance)) return false;
  }
  return true;
}

}  // namespace

math::Box<double> box_of(const FrameGeometry& geometry) {
  math::Box<double> box;
  for (const glm::uvec3& triangle : geometry.triangles) {
    if (triangle == glm::uvec3(0)) continue;  // dropped
    for (int k = 0; k < 3; ++k) box.add(dvec3(geometry.positions[triangle[k]]));
  }
  return box;
}

Expected<std::optional<AreaLight>> area_light_of(const Light& light, const WorldLight& placed,
                                                 const AreaLightSettings& settings,
                                                 const math::Box<double>& box) {
  const bool is_area = light.type == LightType::area_rect || light.type == LightType::area_disk;
  const glm::dvec2 size_m = point_size_m(placed.light, settings, box);
  const bool sized = size_m.x > 0 && size_m.y > 0;
  const bool is_sun = light.type == LightType::directional;
  const float diameter = sun_diameter(light, placed.light, settings);
  if (is_sun ? diameter == 0 : !is_area && !sized) return std::optional<AreaLight>();
  auto made = is_sun    ? make_sun(-placed.direction, static_cast<double>(diameter))
              : is_area ? placed_polygon(light, placed)
                        : rectangle_of_point(light, placed, settings, box);
  if (!made) return tl::unexpected(std::move(made.error()));
  return std::optional<AreaLight>(std::move(*made));
}

bool lies_in_plane(const AreaLight& light, const vec3 corners[3]) {
  return within(light, corners, plane_tolerance(light));
}

bool casters_off_plane(const FrameGeometry& geometry, const AreaLight& light,
                       std::vector<std::uint8_t>& out) {
  if (light.at_infinity) return false;
  const double tolerance = plane_tolerance(light);
  bool found = false;
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const glm::uvec3 t = geometry.triangles[i];
    const vec3 corners[3] = {geometry.positions[t.x], geometry.positions[t.y], geometry.positions[t.z]};
    if (geometry.casts_shadow[i] == 0 || !within(light, corners, tolerance)) continue;
    if (!found) out = geometry.casts_shadow;
    found = true;
    out[i] = 0;
  }
  return found;
}

}  // namespace tenebra::render
