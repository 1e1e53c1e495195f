#include "window/light_edits.h"

#include <sstream>

#include "option_values.h"

namespace tenebra::viewer {
namespace {

LightEdit edit_of(const LightEdits& edits, int light) {
  const auto index = static_cast<std::size_t>(light);
  return index < edits.size() ? edits[index] : LightEdit{};
}

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
  if (key == "intensity" || key == "size") {
    const auto factor = parse_positive(value);
    if (!factor) return tl::unexpected(factor.error());
    (key == "size" ? edit.size : edit.intensity) = static_cast<float>(*factor);
    return {};
  }
  return fail("found {}={}, expected on=0, on=1, intensity=FACTOR, move=X,Y,Z or size=FACTOR", key, value);
}

}  // namespace

Expected<void> parse_light_edit(const std::string& text, LightEdits& edits) {
  std::istringstream words(text);
  std::string word;
  words >> word;
  const auto light = parse_count(word);
  if (!light) return fail("found {}, expected the number of a light and KEY=VALUE, like \"0 on=0\"", text);
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

std::string light_edit_text(int light, const LightEdit& edit) {
  std::string text;
  if (!edit.on) text += " on=0";
  if (edit.intensity != 1) text += fmt::format(" intensity={}", edit.intensity);
  if (edit.move != glm::vec3(0.0f))
    text += fmt::format(" move={},{},{}", edit.move.x, edit.move.y, edit.move.z);
  if (edit.size != 1) text += fmt::format(" size={}", edit.size);
  return text.empty() ? "" : fmt::format("{}{}", light, text);
}

std::vector<Light> edited_lights(const std::vector<Light>& lights, const LightEdits& edits) {
  std::vector<Light> edited = lights;
  for (std::size_t i = 0; i < edited.size(); ++i) {
    const LightEdit edit = edit_of(edits, static_cast<int>(i));
    edited[i].intensity *= edit.intensity;
    edited[i].size_m *= edit.size;
  }
  return edited;
}

std::vector<WorldLight> edited_lights(std::vector<WorldLight> lights, const LightEdits& edits) {
  std::erase_if(lights, [&](const WorldLight& light) { return !edit_of(edits, light.light).on; });
  for (WorldLight& light : lights) {
    const LightEdit edit = edit_of(edits, light.light);
    light.position += edit.move;
    light.axis_x *= edit.size;
    light.axis_y *= edit.size;
  }
  return lights;
}

}  // namespace tenebra::viewer
