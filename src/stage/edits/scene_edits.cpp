#include "stage/edits/scene_edits.h"

#include <algorithm>

#include "base/fail.h"

namespace tenebra::stage {
namespace {

template <class Edits, class List>
Expected<void> check_numbers(const char* option, const char* of, const Edits& edits, const List& list) {
  if (edits.empty() || edits.rbegin()->first < static_cast<int>(list.size())) return {};
  return base::fail("{}: found {} {}, the scene has {} of them, counted from 0", option, of,
                    edits.rbegin()->first, list.size());
}

}  // namespace

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

std::vector<Light> lights_of(const Scene& scene, const SceneEdits& edits, bool have_units) {
  std::vector<Light> lights = scene.lights;
  for (const AddedLight& added : edits.added) {
    Light& light = lights.emplace_back();
    light.name = "added";
    light.type = added.type;
    light.falloff = have_units ? Falloff::inverse_square : Falloff::none;
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
    light.position = glm::vec3(scene.frame.to_scene(added.position));
    light.direction = glm::vec3(0, -1, 0);
    if (added.direction)
      light.direction =
          glm::normalize(glm::vec3(scene.frame.direction_to_scene(glm::dvec3(*added.direction))));
  }
  return lights;
}

std::vector<WorldLight> placed_lights(const Scene& scene, const SceneEdits& edits, int clip, double time_s) {
  return edited_lights(unmoved_lights(scene, edits, clip, time_s), edits.lights, scene.frame);
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

}  // namespace tenebra::stage
