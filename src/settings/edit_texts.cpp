#include "settings/edit_texts.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "base/fail.h"
#include "settings/setting.h"
#include "settings/text_values.h"

namespace tenebra::settings {
namespace {

Expected<void> apply(const std::string& key, const std::string& value, stage::LightEdit& edit) {
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
    if (!size || size->percent || size->size.x <= 0)
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
std::string text_of(const stage::LightEdit& edit) {
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

struct LightKind {
  const char* name;
  LightType type;
};
constexpr std::array light_kinds{LightKind{"point", LightType::point}, LightKind{"spot", LightType::spot},
                                 LightKind{"directional", LightType::directional}};

/// The words after the first as KEY and VALUE.
template <class Apply>
Expected<void> read_words(std::istringstream& words, const Apply& apply) {
  for (std::string word; words >> word;) {
    const auto sign = word.find('=');
    const std::string value = sign == std::string::npos ? "" : word.substr(sign + 1);
    if (auto applied = apply(word.substr(0, sign), value); !applied) return applied;
  }
  return {};
}

Expected<int> read_number(std::istringstream& words, const std::string& text, const char* of,
                          const char* like) {
  std::string word;
  words >> word;
  const auto number = parse_count(word);
  if (!number)
    return base::fail("found {}, expected the number of a {} and KEY=VALUE, like \"{}\"", text, of, like);
  return *number;
}

Expected<glm::vec3> parse_color(const std::string& key, const std::string& text) {
  const auto color = parse_vector(text);
  if (!color) return color;
  if (glm::any(glm::lessThan(*color, glm::vec3(0.0f))))
    return base::fail("found {}={}, expected R,G,B from 0 on", key, text);
  return color;
}

Expected<float> parse_share(const std::string& key, const std::string& text) {
  std::istringstream stream(text);
  float value = -1;
  if (!(stream >> value) || !stream.eof() || !(value >= 0 && value <= 1))
    return base::fail("found {}={}, expected a number from 0 to 1", key, text);
  return value;
}

template <class Value, class Target>
Expected<void> take(const Expected<Value>& value, Target& target) {
  if (!value) return tl::unexpected(value.error());
  target = *value;
  return {};
}

Expected<void> apply(const std::string& key, const std::string& value, stage::AddedLight& light) {
  if (key == "color") return take(parse_color(key, value), light.color);
  if (key == "intensity") return take(parse_factor(value), light.intensity);
  if (key == "position") return take(parse_place(value), light.position);
  if (key == "direction") {
    if (auto taken = take(parse_vector(value), light.direction); !taken) return taken;
    if (*light.direction != glm::vec3(0.0f)) return {};
  }
  return base::fail("found {}={}, expected position=X,Y,Z, direction=X,Y,Z, color=R,G,B or intensity=VALUE",
                    key, value);
}

Expected<void> apply(const std::string& key, const std::string& value, stage::MaterialEdit& edit) {
  if (key == "color") return take(parse_color(key, value), edit.color);
  if (key == "emissive") return take(parse_color(key, value), edit.emissive);
  if (key == "specular") return take(parse_color(key, value), edit.specular);
  if (key == "roughness") return take(parse_share(key, value), edit.roughness);
  if (key == "metallic") return take(parse_share(key, value), edit.metallic);
  return base::fail(
      "found {}={}, expected color=R,G,B, emissive=R,G,B, specular=R,G,B, roughness=VALUE or metallic=VALUE",
      key, value);
}

Expected<void> apply(const std::string& key, const std::string& value, stage::NodeEdit& edit) {
  const bool is_flag = value == "0" || value == "1";
  if (is_flag && key == "visible") return edit.visible = value == "1", Expected<void>();
  if (is_flag && key == "casts") return edit.casts = value == "1", Expected<void>();
  return base::fail("found {}={}, expected visible=0, visible=1, casts=0 or casts=1", key, value);
}

const char* kind_name(LightType type) {
  const auto kind = std::find_if(light_kinds.begin(), light_kinds.end(),
                                 [&](const LightKind& of) { return of.type == type; });
  return kind == light_kinds.end() ? "point" : kind->name;
}

std::string text_of(const stage::AddedLight& light) {
  const std::string direction =
      light.direction ? fmt::format(" direction={}", vector_text(*light.direction)) : "";
  return fmt::format("{} position={}{} intensity={} color={}", kind_name(light.type),
                     place_text(light.position), direction, light.intensity, vector_text(light.color));
}

/// " KEY=VALUE ..." of what the edit changes.
std::string text_of(const stage::MaterialEdit& edit) {
  std::string text;
  if (edit.color) text += " color=" + vector_text(*edit.color);
  if (edit.emissive) text += " emissive=" + vector_text(*edit.emissive);
  if (edit.specular) text += " specular=" + vector_text(*edit.specular);
  if (edit.roughness) text += fmt::format(" roughness={}", *edit.roughness);
  if (edit.metallic) text += fmt::format(" metallic={}", *edit.metallic);
  return text;
}
std::string text_of(const stage::NodeEdit& edit) {
  return std::string(edit.visible ? "" : " visible=0") + (edit.casts ? "" : " casts=0");
}

}  // namespace

Expected<void> parse_light_edit(const std::string& text, stage::LightEdits& edits) {
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

std::vector<std::string> light_edit_texts(const stage::LightEdits& edits) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const std::string text = text_of(edits[i]);
    if (!text.empty()) texts.push_back(fmt::format("{}{}", i, text));
  }
  return texts;
}

Expected<void> parse_added_light(const std::string& text, stage::SceneEdits& edits) {
  std::istringstream words(text);
  std::string name;
  words >> name;
  const auto kind = std::find_if(light_kinds.begin(), light_kinds.end(),
                                 [&](const LightKind& of) { return of.name == name; });
  if (kind == light_kinds.end())
    return base::fail("found {}, expected point, spot or directional and KEY=VALUE", text);
  stage::AddedLight light{.type = kind->type};
  const auto read =
      read_words(words, [&](const auto& key, const auto& value) { return apply(key, value, light); });
  if (!read) return read;
  edits.added.push_back(light);
  return {};
}

Expected<void> parse_material_edit(const std::string& text, stage::SceneEdits& edits) {
  std::istringstream words(text);
  const auto number = read_number(words, text, "material", "0 color=1,0,0");
  if (!number) return tl::unexpected(number.error());
  stage::MaterialEdit& edit = edits.materials[*number];
  return read_words(words, [&](const auto& key, const auto& value) { return apply(key, value, edit); });
}

Expected<void> parse_node_edit(const std::string& text, stage::SceneEdits& edits) {
  std::istringstream words(text);
  const auto number = read_number(words, text, "node", "3 visible=0");
  if (!number) return tl::unexpected(number.error());
  stage::NodeEdit& edit = edits.nodes[*number];
  return read_words(words, [&](const auto& key, const auto& value) { return apply(key, value, edit); });
}

std::vector<EditOption> edit_options(const stage::SceneEdits& edits) {
  std::vector<EditOption> options;
  for (const stage::AddedLight& light : edits.added) options.push_back({"--add-light", text_of(light)});
  for (std::string& text : light_edit_texts(edits.lights))
    options.push_back({"--set-light", std::move(text)});
  for (const auto& [material, edit] : edits.materials) {
    if (edit != stage::MaterialEdit{})
      options.push_back({"--set-material", fmt::format("{}{}", material, text_of(edit))});
  }
  for (const auto& [node, edit] : edits.nodes) {
    if (edit != stage::NodeEdit{})
      options.push_back({"--set-node", fmt::format("{}{}", node, text_of(edit))});
  }
  return options;
}

std::string setting_name(const EditOption& option) {
  return underscored(option.name + 2);
}

}  // namespace tenebra::settings
