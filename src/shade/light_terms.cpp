#include "shade/light_terms.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace tenebra::shade {
namespace {

bool is_area(LightType type) {
  return type == LightType::area_rect || type == LightType::area_disk;
}

/// Intensity on the axis (with `area`: radiance) times colour, and 1/pi of the diffuse reflection for lights
/// with units.
glm::vec3 scaled_color(const DrawnLight& drawn) {
  const Light& light = drawn.light;
  glm::vec3 color = light.color * light.intensity;
  const float half_area = glm::length(glm::cross(drawn.placed.axis_x, drawn.placed.axis_y));
  if (drawn.area) {
    if (!is_area(light.type)) color /= static_cast<float>(drawn.area->area_m2);
  } else if (is_area(light.type)) {
    color *= (light.type == LightType::area_rect ? 4.0f : glm::pi<float>()) * half_area;
  }
  return light.falloff == Falloff::inverse_square ? color / glm::pi<float>() : color;
}

/// The exponent of the distance.
int power_of_distance(const Light& light, bool by_irradiance) {
  if (light.type == LightType::directional) return 0;
  const int of_point = light.falloff == Falloff::inverse_square ? -2 : 0;
  return by_irradiance ? of_point + 2 : of_point;  // irradiance falls off by itself
}

/// Scale and offset of the cosine, as KHR_lights_punctual gives them.
glm::vec2 cone_fade(const Light& light) {
  constexpr float min_width = 0.001f;  // the extension's
  const float cos_outer = std::cos(light.outer_cone_rad);
  const float scale = 1.0f / std::max(min_width, std::cos(light.inner_cone_rad) - cos_outer);
  return {scale, -cos_outer * scale};
}

void set_polygon(const AreaLight& area, const ViewRays& view, LightTerms& terms) {
  terms.area_weight = area.at_infinity ? 0.0f : 1.0f;
  terms.area_from_eye = area.centre - static_cast<double>(terms.area_weight) * glm::dvec3(view.eye);
  terms.area_normal = area.normal;
  terms.axis_x = area.ex;
  terms.axis_y = area.ey;
  terms.corner_count = static_cast<int>(std::min(area.polygon.size(), terms.corners.size()));
  for (int i = 0; i < terms.corner_count; ++i)
    terms.corners[static_cast<std::size_t>(i)] = area.polygon[static_cast<std::size_t>(i)];
  terms.radius_m = static_cast<float>(std::sqrt(area.area_m2 / glm::pi<double>()));
}

}  // namespace

LightTerms light_terms(const DrawnLight& drawn, const ViewRays& view) {
  LightTerms terms;
  terms.color = scaled_color(drawn);
  terms.from_eye = drawn.placed.position - view.eye;
  terms.direction = drawn.placed.direction;
  terms.directional = drawn.light.type == LightType::directional;
  terms.spot = drawn.light.type == LightType::spot;
  if (terms.spot) terms.cone = cone_fade(drawn.light);
  terms.range_m = drawn.light.range_m.value_or(0.0f);
  terms.by_irradiance = drawn.area.has_value();
  if (drawn.area) set_polygon(*drawn.area, view, terms);
  terms.distance_power = power_of_distance(drawn.light, terms.by_irradiance);
  terms.cosine_emitter = is_area(drawn.light.type) && !terms.by_irradiance;
  return terms;
}

double fade_of(const LightTerms& terms, const glm::dvec3& to_light, double distance) {
  constexpr double brightest = 1e30;
  double fade = 1;
  const double cosine = -glm::dot(glm::dvec3(terms.direction), to_light);
  if (terms.spot) {
    const double cone =
        std::clamp(cosine * static_cast<double>(terms.cone.x) + static_cast<double>(terms.cone.y), 0.0, 1.0);
    fade = cone * cone;
  }
  if (terms.cosine_emitter) fade *= std::max(cosine, 0.0);
  if (terms.range_m > 0) {
    const double near = distance / static_cast<double>(terms.range_m);
    fade *= std::clamp(1 - near * near * near * near, 0.0, 1.0);
  }
  if (terms.distance_power < 0) fade /= distance * distance;
  if (terms.distance_power > 0) fade *= distance * distance;
  return std::min(fade, brightest);
}

}  // namespace tenebra::shade
