// What the user changes about a scene: its lights and new ones, colours of materials, which nodes are visible
// and cast shadows. Values beside the scene, which stays as it was imported.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "stage/edits/light_edits.h"

namespace tenebra::stage {

/// A light that the scene does not have. Its number follows the scene's; LightEdits change it as any other.
struct AddedLight {
  LightType type = LightType::point;
  glm::dvec3 position{0.0};              ///< in the coordinates of the scene's file
  std::optional<glm::vec3> direction{};  ///< in the file's axes, any length but zero; none: down
  float intensity = 1;                   ///< see lights_of
  glm::vec3 color{1.0f};

  bool operator==(const AddedLight&) const = default;
};

/// What takes the place of a material's values; none: the scene's.
struct MaterialEdit {
  std::optional<glm::vec3> color;  ///< Material::base_color
  std::optional<glm::vec3> emissive;
  std::optional<glm::vec3> specular;
  std::optional<float> roughness;  ///< 0 to 1
  std::optional<float> metallic;   ///< 0 to 1

  bool operator==(const MaterialEdit&) const = default;
};

/// What is changed of a node and all below it.
struct NodeEdit {
  bool visible = true;  ///< false hides what the scene shows
  bool casts = true;    ///< false keeps it from casting shadows

  bool operator==(const NodeEdit&) const = default;
};

struct SceneEdits {
  LightEdits lights;  ///< by number: Scene::lights, then `added`
  std::vector<AddedLight> added;
  std::map<int, MaterialEdit> materials;  ///< by index into Scene::materials
  std::map<int, NodeEdit> nodes;          ///< by index into Scene::nodes

  bool operator==(const SceneEdits&) const = default;
  LightEdit& light(int number) {
    const auto index = static_cast<std::size_t>(number);
    if (lights.size() <= index) lights.resize(index + 1);
    return lights[index];
  }
};

/// Fails with a sentence on numbers of lights, materials and nodes that the scene does not have.
Expected<void> check_edits(const SceneEdits& edits, const Scene& scene);

/// The scene's lights and the added ones, with their edits. Intensities of added ones are candela and lux
/// where lights `have_units`; else they are what white shows that faces the light, at every distance.
std::vector<Light> lights_of(const Scene& scene, const SceneEdits& edits, bool have_units);
/// Where they stand at one instant, before and with their edits. Each light of the scene has its own node.
std::vector<WorldLight> unmoved_lights(const Scene& scene, const SceneEdits& edits, int clip, double time_s);
std::vector<WorldLight> placed_lights(const Scene& scene, const SceneEdits& edits, int clip, double time_s);
/// The scene's materials with their edits.
std::vector<Material> materials_of(const Scene& scene, const SceneEdits& edits);
/// Drops the triangles of hidden nodes from an evaluated frame of `scene`, and the shadows of nodes that are
/// not to cast any, as if the scene were made so.
void apply_node_edits(const Scene& scene, const SceneEdits& edits, FrameGeometry& geometry);

}  // namespace tenebra::stage
