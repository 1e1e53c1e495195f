#include "render/frame_lights.h"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>

#include "base/fail.h"
#include "render/emissive.h"
#include "soft/light/even_emission.h"

namespace tenebra::render {

namespace {

std::string title(const DrawnLight& drawn) {
  return drawn.light.name.empty() ? fmt::format("light {}", drawn.number)
                                  : fmt::format("light {} ({})", drawn.number, drawn.light.name);
}

void give_area(DrawnLight& drawn, const AreaLightSettings& settings, const math::Box<double>& box,
               std::vector<std::string>& notes) {
  auto area = area_light_of(drawn.light, drawn.placed, settings, box);
  if (area && *area) {
    drawn.area = std::move(**area);
    const bool made = drawn.light.type == LightType::point || drawn.light.type == LightType::spot;
    if (made && settings.emission == LightEmission::point) drawn.back = soft::reversed(*drawn.area);
  } else if (!area) {
    notes.push_back(fmt::format("{} keeps hard shadows: {}", title(drawn), area.error().message));
  } else if (drawn.light.type == LightType::directional) {
    notes.push_back(
        fmt::format("{} is directional and keeps hard shadows, unless --light-size sun=DEGREES or "
                    "--set-light gives it a diameter",
                    title(drawn)));
  } else {
    notes.push_back(fmt::format(
        "{} is a point and keeps hard shadows, unless --light-size or --set-light gives it a size",
        title(drawn)));
  }
}

bool has_own(const auto& list, int number) {
  const auto index = static_cast<std::size_t>(number);
  return index < list.size() && list[index].has_value();
}

/// Names the sizes that lights without one got.
void note_sizes(const std::vector<DrawnLight>& lights, const AreaLightSettings& settings,
                const math::Box<double>& box, std::vector<std::string>& notes) {
  bool points = false, suns = false;
  for (const DrawnLight& drawn : lights) {
    const bool sun = drawn.light.type == LightType::directional;
    const bool point = drawn.light.type == LightType::point || drawn.light.type == LightType::spot;
    if (!drawn.area || drawn.light.intensity == 0) continue;
    points |= point && settings.size == glm::vec2(0.0f) && !has_own(settings.own_size_m, drawn.number);
    suns |= sun && drawn.light.diameter_deg == 0 && !settings.sun_deg &&
            !has_own(settings.own_sun_deg, drawn.number);
  }
  if (points)
    notes.push_back(
        fmt::format("point lights have no size: {:.3g} m were taken, {:g} % of the scene's diagonal "
                    "(--light-size sets it, "
                    "0 keeps hard shadows)",
                    0.01 * settings.unsized_percent * box.diagonal(), settings.unsized_percent));
  if (suns)
    notes.push_back(
        fmt::format("directional lights have no size: {:g} degrees were taken, the sun's (--light-size "
                    "sun=DEGREES sets it, 0 keeps hard shadows)",
                    settings.unsized_sun_deg));
}

/// A polygon of the scene that is the face of a lamp which `lights` already hold.
bool is_face_of_a_light(const AreaLight& polygon, const std::vector<DrawnLight>& lights) {
  for (const DrawnLight& drawn : lights) {
    if (!drawn.area || drawn.light.type == LightType::point || drawn.light.type == LightType::spot) continue;
    const std::vector<glm::vec3>& v = polygon.vertices;
    const glm::vec3 corners[3] = {v[0], v[1], v[2]};
    const double apart = glm::length(polygon.centre - drawn.area->centre);
    if (lies_in_plane(*drawn.area, corners) && apart * apart < polygon.area_m2) return true;
  }
  return false;
}

void add_emissive(const Scene& scene, const FrameInput& input, std::vector<DrawnLight>& lights,
                  std::vector<std::string>& notes) {
  int number = static_cast<int>(input.lights.size());
  for (EmissivePolygon& polygon : emissive_polygons(scene, input.geometry, notes)) {
    if (is_face_of_a_light(polygon.area, lights)) {
      notes.push_back(fmt::format("mesh {} is the face of an area light and counts once", polygon.mesh));
      continue;
    }
    DrawnLight drawn;
    drawn.number = number++;
    drawn.light.name = polygon.mesh;
    drawn.light.type = LightType::area_rect;
    drawn.light.color = polygon.radiance;
    drawn.placed.position = glm::vec3(polygon.area.centre);
    drawn.placed.direction = glm::vec3(polygon.area.normal);
    drawn.area = std::move(polygon.area);
    lights.push_back(std::move(drawn));
  }
}

}  // namespace

bool has_areas(std::span<const DrawnLight> lights) {
  return std::any_of(lights.begin(), lights.end(),
                     [](const DrawnLight& light) { return light.area.has_value(); });
}

bool shines_behind(const DrawnLight& light) {
  const bool narrow =
      light.light.type == LightType::spot && light.light.outer_cone_rad <= 0.5f * std::numbers::pi_v<float>;
  return light.back && !narrow;
}

Expected<std::vector<DrawnLight>> drawn_lights(const Scene& scene, const FrameInput& input,
                                               const RenderSettings& settings,
                                               std::vector<std::string>& notes) {
  std::vector<DrawnLight> lights;
  for (const WorldLight& placed : input.lights) {
    const int number = static_cast<int>(lights.size());
    lights.push_back({.light = light_at(scene, placed), .placed = placed, .number = number});
  }
  if (settings.shadows == ShadowMode::soft) {
    const math::Box<double> box = box_of(input.geometry);
    for (DrawnLight& drawn : lights) {
      std::vector<std::string> unasked;
      const bool asked = drawn.light.intensity != 0 && (settings.light < 0 || settings.light == drawn.number);
      give_area(drawn, settings.area_lights, box, asked ? notes : unasked);
    }
    note_sizes(lights, settings.area_lights, box, notes);
    if (settings.area_lights.emissive_quads) add_emissive(scene, input, lights, notes);
  }
  if (settings.light >= static_cast<int>(lights.size())) {
    return base::fail("light {}: the scene has {} lights, counted from 0", settings.light, lights.size());
  }
  std::erase_if(lights, [&](const DrawnLight& drawn) {
    return drawn.light.intensity == 0 || (settings.light >= 0 && drawn.number != settings.light);
  });
  return lights;
}

}  // namespace tenebra::render
