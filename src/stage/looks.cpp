#include "stage/looks.h"

#include <algorithm>

namespace tenebra::stage {
namespace {

const Material& material_of(const Scene& scene, std::uint32_t index) {
  return scene.materials[std::min<std::size_t>(index, scene.materials.size() - 1)];
}

bool has_see_through(const Scene& scene, const Mesh& mesh) {
  return std::any_of(mesh.materials.begin(), mesh.materials.end(),
                     [&](std::uint32_t index) { return material_of(scene, index).see_through(); });
}

bool is_blank(const Material& material) {
  return material.emissive == glm::vec3(1.0f) && !material.emissive_map &&
         material.model != SurfaceModel::unlit;
}

}  // namespace

void make_plain(Scene& scene) {
  for (Mesh& mesh : scene.meshes)
    if (!has_see_through(scene, mesh)) mesh.colors.clear();
  for (Material& material : scene.materials) {
    if (material.model != SurfaceModel::unlit) material.model = SurfaceModel::phong;
    material.specular = glm::vec3(0.0f);
    material.specular_map = material.metallic_roughness_map = material.exponent_map = {};
    material.normal_map = material.occlusion_map = {};
    if (material.emissive_map) material.emissive = glm::vec3(0.0f);
    material.emissive_map = {};
    if (!material.see_through()) material.base_color_map = {};
  }
}

void leave_out_blank_emission(Scene& scene) {
  bool any = false;
  for (const Mesh& mesh : scene.meshes) {
    for (const std::uint32_t index : mesh.materials) {
      if (!is_blank(material_of(scene, index))) return;
      any = true;
    }
  }
  if (!any) return;
  for (Material& material : scene.materials)
    if (is_blank(material)) material.emissive = glm::vec3(0.0f);
  scene.warnings.push_back(
      "Every surface has an emissive factor of 1, 1, 1 without a texture, as if a texture was lost: the "
      "emission is left out.");
}

}  // namespace tenebra::stage
