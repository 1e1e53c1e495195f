#include "options/light_edits.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <sstream>

#include "base/fail.h"
#include "options/option_values.h"

namespace tenebra::viewer {
namespace {

Expected<void> apply(const std::string& key, const std::string& value, LightEdit& edit) {
  if (key == "on" && (value == "0" || value == "1")) {
    edit.on = value == "1";
    return {};
  }
  if (key == "move") {
    const auto moved = parse_vector(value);
    if (!moved) return tl::unexpected(moved.error());
    edit.move = *moved;
    return {};
  }
  if (key == "intensity") {
    const auto factor = parse_factor(value);
    if (!factor) return tl::unexpected(factor.error());
    edit.intensity = *factor;
    return {};
  }
  if (key == "size") {
    const auto size = parse_light_size(value);
    if (!size || size->percent)
      return base::fail("found size={}, expected W or WxH in metres, like 0.5x0.3", value);
    edit.size_m = size->size;
    return {};
  }
  if (key == "diameter") {
    const auto diameter = parse_sun_size(value);
    if (!diameter) return tl::unexpected(diameter.error());
    edit.diameter_deg = *diameter;
    return {};
  }
  if (key == "color" || key == "direction") {
    const auto vector = parse_vector(value);
    if (!vector) return tl::unexpected(vector.error());
    if (key == "direction" && *vector == glm::vec3(0.0f))
      return base::fail("found direction={}, expected a direction, like 0,-1,0", value);
    if (key == "color" && glm::any(glm::lessThan(*vector, glm::vec3(0.0f))))
      return base::fail("found color={}, expected R,G,B from 0 on", value);
    (key == "color" ? edit.color : edit.direction) = *vector;
    return {};
  }
  return base::fail(
      "found {}={}, expected on=0, on=1, intensity=FACTOR, color=R,G,B, direction=X,Y,Z, move=X,Y,Z, "
      "size=WxH or diameter=DEGREES",
      key, value);
}

/// " KEY=VALUE ..." of what the edit changes.
std::string text_of(const LightEdit& edit) {
  std::string text;
  const auto vector = [](const char* key, const glm::vec3& v) {
    return fmt::format(" {}={},{},{}", key, v.x, v.y, v.z);
  };
  if (!edit.on || edit.deleted) text += " on=0";
  if (edit.intensity != 1) text += fmt::format(" intensity={}", edit.intensity);
  if (edit.color) text += vector("color", *edit.color);
  if (edit.direction) text += vector("direction", *edit.direction);
  if (edit.move != glm::vec3(0.0f)) text += vector("move", edit.move);
  if (edit.size_m) text += fmt::format(" size={}x{}", edit.size_m->x, edit.size_m->y);
  if (edit.diameter_deg) text += fmt::format(" diameter={}", *edit.diameter_deg);
  return text;
}

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

Expected<void> parse_light_edit(const std::string& text, LightEdits& edits) {
  std::istringstream words(text);
  std::string word;
  words >> word;
  const auto light = parse_count(word);
  if (!light)
    return base::fail("found {}, expected the number of a light and KEY=VALUE, like \"0 on=0\"", text);
  if (edits.size() <= static_cast<std::size_t>(*light)) edits.resize(static_cast<std::size_t>(*light) + 1);
  while (words >> word) {
    const auto sign = word.find('=');
    const std::string value = sign == std::string::npos ? "" : word.substr(sign + 1);
    if (auto applied = apply(word.substr(0, sign), value, edits[static_cast<std::size_t>(*light)]);
        !applied) {
      return applied;
    }
  }
  return {};
}

std::vector<std::string> light_edit_texts(const LightEdits& edits) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const std::string text = text_of(edits[i]);
    if (!text.empty()) texts.push_back(fmt::format("{}{}", i, text));
  }
  return texts;
}

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

std::vector<WorldLight> edited_lights(std::vector<WorldLight> lights, const LightEdits& edits) {
  const auto resize = [](glm::vec3& half_axis, float size_m) {
    const float length = glm::length(half_axis);
    if (length > 0) half_axis *= 0.5f * size_m / length;
  };
  for (WorldLight& light : lights) {
    const LightEdit edit = edit_of(edits, light.light);
    light.position += edit.move;
    if (light.intensity) *light.intensity *= factor_of(edit);
    if (light.color && edit.color) light.color = edit.color;
    if (edit.direction) turn(light, *edit.direction);
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

}  // namespace tenebra::viewer
