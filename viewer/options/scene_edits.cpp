#include "options/scene_edits.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "base/fail.h"
#include "options/option_values.h"

namespace tenebra::viewer {
namespace {

struct LightKind {
  const char* name;
  LightType type;
};
constexpr std::array light_kinds{LightKind{"point", LightType::point}, LightKind{"spot", LightType::spot},
                                 LightKind{"directional", LightType::directional}};

std::string vector_text(const glm::vec3& v) {
  return fmt::format("{},{},{}", v.x, v.y, v.z);
}

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

Expected<void> apply(const std::string& key, const std::string& value, AddedLight& light) {
  if (key == "color") return take(parse_color(key, value), light.color);
  if (key == "intensity") return take(parse_factor(value), light.intensity);
  if (key == "position") return take(parse_vector(value), light.position);
  if (key == "direction") {
    if (auto taken = take(parse_vector(value), light.direction); !taken) return taken;
    if (light.direction != glm::vec3(0.0f)) return {};
  }
  return base::fail("found {}={}, expected position=X,Y,Z, direction=X,Y,Z, color=R,G,B or intensity=VALUE",
                    key, value);
}

Expected<void> apply(const std::string& key, const std::string& value, MaterialEdit& edit) {
  if (key == "color") return take(parse_color(key, value), edit.color);
  if (key == "emissive") return take(parse_color(key, value), edit.emissive);
  if (key == "specular") return take(parse_color(key, value), edit.specular);
  if (key == "roughness") return take(parse_share(key, value), edit.roughness);
  if (key == "metallic") return take(parse_share(key, value), edit.metallic);
  return base::fail(
      "found {}={}, expected color=R,G,B, emissive=R,G,B, specular=R,G,B, roughness=VALUE or metallic=VALUE",
      key, value);
}

Expected<void> apply(const std::string& key, const std::string& value, NodeEdit& edit) {
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

std::string text_of(const AddedLight& light) {
  return fmt::format("{} position={} direction={} intensity={} color={}", kind_name(light.type),
                     vector_text(light.position), vector_text(light.direction), light.intensity,
                     vector_text(light.color));
}

/// " KEY=VALUE ..." of what the edit changes.
std::string text_of(const MaterialEdit& edit) {
  std::string text;
  if (edit.color) text += " color=" + vector_text(*edit.color);
  if (edit.emissive) text += " emissive=" + vector_text(*edit.emissive);
  if (edit.specular) text += " specular=" + vector_text(*edit.specular);
  if (edit.roughness) text += fmt::format(" roughness={}", *edit.roughness);
  if (edit.metallic) text += fmt::format(" metallic={}", *edit.metallic);
  return text;
}
std::string text_of(const NodeEdit& edit) {
  return std::string(edit.visible ? "" : " visible=0") + (edit.casts ? "" : " casts=0");
}

template <class Edits, class List>
Expected<void> check_numbers(const char* option, const char* of, const Edits& edits, const List& list) {
  if (edits.empty() || edits.rbegin()->first < static_cast<int>(list.size())) return {};
  return base::fail("{}: found {} {}, the scene has {} of them, counted from 0", option, of,
                    edits.rbegin()->first, list.size());
}

}  // namespace

Expected<void> parse_added_light(const std::string& text, SceneEdits& edits) {
  std::istringstream words(text);
  std::string name;
  words >> name;
  const auto kind = std::find_if(light_kinds.begin(), light_kinds.end(),
                                 [&](const LightKind& of) { return of.name == name; });
  if (kind == light_kinds.end())
    return base::fail("found {}, expected point, spot or directional and KEY=VALUE", text);
  AddedLight light{.type = kind->type};
  const auto read =
      read_words(words, [&](const auto& key, const auto& value) { return apply(key, value, light); });
  if (!read) return read;
  edits.added.push_back(light);
  return {};
}

Expected<void> parse_material_edit(const std::string& text, SceneEdits& edits) {
  std::istringstream words(text);
  const auto number = read_number(words, text, "material", "0 color=1,0,0");
  if (!number) return tl::unexpected(number.error());
  MaterialEdit& edit = edits.materials[*number];
  return read_words(words, [&](const auto& key, const auto& value) { return apply(key, value, edit); });
}

Expected<void> parse_node_edit(const std::string& text, SceneEdits& edits) {
  std::istringstream words(text);
  const auto number = read_number(words, text, "node", "3 visible=0");
  if (!number) return tl::unexpected(number.error());
  NodeEdit& edit = edits.nodes[*number];
  return read_words(words, [&](const auto& key, const auto& value) { return apply(key, value, edit); });
}

std::vector<EditOption> edit_options(const SceneEdits& edits) {
  std::vector<EditOption> options;
  for (const AddedLight& light : edits.added) options.push_back({"--add-light", text_of(light)});
  for (std::string& text : light_edit_texts(edits.lights))
    options.push_back({"--set-light", std::move(text)});
  for (const auto& [material, edit] : edits.materials) {
    if (edit != MaterialEdit{})
      options.push_back({"--set-material", fmt::format("{}{}", material, text_of(edit))});
  }
  for (const auto& [node, edit] : edits.nodes) {
    if (edit != NodeEdit{}) options.push_back({"--set-node", fmt::format("{}{}", node, text_of(edit))});
  }
  return options;
}

std::string setting_name(const EditOption& option) {
  std::string name = option.name + 2;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

Expected<void> check_edits(const SceneEdits& edits, const Scene& scene) {
  const std::size_t lights = scene.lights.size() + edits.added.size();
  if (edits.lights.size() > lights) {
    return base::fail("--set-light: found light {}, the scene has lights 0 to {}", edits.lights.size() - 1,
                      static_cast<int>(lights) - 1);
  }
  if (auto checked = check_numbers("--set-material", "material", edits.materials, scene.materials); !checked)
    return checked;
  return check_numbers("--set-node", "node", edits.nodes, scene.nodes);
}

std::vector<Light> lights_of(const Scene& scene, const SceneEdits& edits) {
  std::vector<Light> lights = scene.lights;
  for (const AddedLight& added : edits.added) {
    Light& light = lights.emplace_back();
    light.name = "added";
    light.type = added.type;
    light.falloff = Falloff::none;
    light.color = added.color;
    light.intensity = added.intensity;
  }
  return edited_lights(std::move(lights), edits.lights);
}

std::vector<WorldLight> unmoved_lights(const Scene& scene, const SceneEdits& edits, int clip, double time_s) {
  std::vector<WorldLight> lights = evaluate_lights(scene, clip, time_s);
  for (const AddedLight& added : edits.added) {
    WorldLight& light = lights.emplace_back();
    light.light = static_cast<int>(lights.size()) - 1;
    light.position = added.position;
    light.direction = glm::normalize(added.direction);
  }
  return lights;
}

std::vector<WorldLight> placed_lights(const Scene& scene, const SceneEdits& edits, int clip, double time_s) {
  return edited_lights(unmoved_lights(scene, edits, clip, time_s), edits.lights);
}

std::vector<Material> materials_of(const Scene& scene, const SceneEdits& edits) {
  std::vector<Material> materials = scene.materials;
  for (const auto& [number, edit] : edits.materials) {
    if (static_cast<std::size_t>(number) >= materials.size()) continue;
    Material& material = materials[static_cast<std::size_t>(number)];
    material.base_color = edit.color.value_or(material.base_color);
    material.emissive = edit.emissive.value_or(material.emissive);
    material.specular = edit.specular.value_or(material.specular);
    material.roughness = edit.roughness.value_or(material.roughness);
    material.metallic = edit.metallic.value_or(material.metallic);
  }
  return materials;
}

void apply_node_edits(const Scene& scene, const SceneEdits& edits, FrameGeometry& geometry) {
  if (edits.nodes.empty()) return;
  std::vector<NodeEdit> inherited(scene.nodes.size());  // parents stand before their children
  std::size_t part = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    NodeEdit& edit = inherited[i];
    if (const auto own = edits.nodes.find(static_cast<int>(i)); own != edits.nodes.end()) edit = own->second;
    if (node.parent >= 0) {
      edit.visible &= inherited[static_cast<std::size_t>(node.parent)].visible;
      edit.casts &= inherited[static_cast<std::size_t>(node.parent)].casts;
    }
    if (!edit.visible) geometry.pose.nodes[i].visible = false;
    if (node.mesh < 0) continue;
    const std::size_t first = geometry.parts[part++];
    const std::size_t last = part < geometry.parts.size() ? geometry.parts[part] : geometry.triangles.size();
    for (std::size_t t = first; t < last; ++t) {
      if (!edit.visible) geometry.triangles[t] = glm::uvec3(0);
      if (!edit.casts) geometry.casts_shadow[t] = 0;
      if (!edit.casts && !geometry.see_through.empty() && geometry.see_through[t] != 0)
        geometry.see_through[t] = 2;
    }
  }
}

}  // namespace tenebra::viewer
