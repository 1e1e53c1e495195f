#include "stage/edits/light_edits.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace tenebra::stage {
namespace {

float factor_of(const LightEdit& edit) {
  return edit.on && !edit.deleted ? edit.intensity : 0.0f;
}

/// Turns a light, its area too, the shortest way.
void turn(WorldLight& light, glm::vec3 direction) {
  const glm::dvec3 from = glm::normalize(glm::dvec3(light.direction)),
                   to = glm::normalize(glm::dvec3(direction));
  const glm::dvec3 side = std::abs(from.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const double cosine = glm::dot(from, to);
  const glm::dquat turned = cosine > -0.999999
                                ? glm::normalize(glm::dquat(1 + cosine, glm::cross(from, to)))
                                : glm::angleAxis(std::numbers::pi, glm::normalize(glm::cross(from, side)));
  light.direction = to;
  light.axis_x = turned * glm::dvec3(light.axis_x);
  light.axis_y = turned * glm::dvec3(light.axis_y);
}

}  // namespace

LightEdit edit_of(const LightEdits& edits, int light) {
  const auto index = static_cast<std::size_t>(light);
  return index < edits.size() ? edits[index] : LightEdit{};
}

std::vector<Light> edited_lights(std::vector<Light> lights, const LightEdits& edits) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const LightEdit edit = edit_of(edits, static_cast<int>(i));
    lights[i].intensity *= factor_of(edit);
    if (edit.color) lights[i].color = *edit.color;
  }
  return lights;
}

std::vector<WorldLight> edited_lights(std::vector<WorldLight> lights, const LightEdits& edits,
                                      const FileFrame& frame) {
  const auto resize = [](glm::vec3& half_axis, float size_m) {
    const float length = glm::length(half_axis);
    if (length > 0) half_axis *= 0.5f * size_m / length;
  };
  for (WorldLight& light : lights) {
    const LightEdit edit = edit_of(edits, light.light);
    light.position += glm::vec3(frame.direction_to_scene(glm::dvec3(edit.move)));
    if (light.intensity) *light.intensity *= factor_of(edit);
    if (light.color && edit.color) light.color = edit.color;
    if (edit.direction) turn(light, glm::vec3(frame.direction_to_scene(glm::dvec3(*edit.direction))));
    if (!edit.size_m) continue;
    resize(light.axis_x, edit.size_m->x);
    resize(light.axis_y, edit.size_m->y);
  }
  return lights;
}

std::vector<std::optional<glm::vec2>> edited_sizes_m(const LightEdits& edits) {
  std::vector<std::optional<glm::vec2>> sizes_m;
  for (const LightEdit& edit : edits) sizes_m.push_back(edit.size_m);
  return sizes_m;
}

std::vector<std::optional<float>> edited_suns_deg(const LightEdits& edits) {
  std::vector<std::optional<float>> suns_deg;
  for (const LightEdit& edit : edits) suns_deg.push_back(edit.diameter_deg);
  return suns_deg;
}

}  // namespace tenebra::stage
