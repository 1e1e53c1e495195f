// Simplified looks: everything but the factors goes, and emission that a lost picture left.
#include "stage/looks.h"

#include <gtest/gtest.h>

namespace tenebra::stage {
namespace {

/// A triangle of each material.
Scene scene_of(std::vector<Material> materials) {
  Scene scene;
  for (std::uint32_t i = 0; i < materials.size(); ++i) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.colors.assign(3, glm::vec4(0.5f));
    mesh.triangles = {{0, 1, 2}};
    mesh.materials = {i};
    scene.meshes.push_back(mesh);
  }
  scene.materials = std::move(materials);
  return scene;
}

Material shining(const glm::vec3& emissive, int image = -1) {
  Material m;
  m.emissive = emissive;
  m.emissive_map.image = image;
  return m;
}

TEST(Looks, PlainSurfacesKeepTheirFactorsAlone) {
  Material metal = shining(glm::vec3(1.0f), 0), glass;
  metal.model = SurfaceModel::metallic_roughness;
  metal.base_color = {1, 0, 0};
  metal.base_color_map.image = metal.metallic_roughness_map.image = 0;
  metal.normal_map.image = metal.occlusion_map.image = 0;
  glass.transmission = 0.5f;
  glass.specular = glm::vec3(1.0f);
  glass.base_color_map.image = 0;
  Scene scene = scene_of({metal, glass});
  make_plain(scene);
  const Material &first = scene.materials[0], &second = scene.materials[1];
  EXPECT_EQ(first.model, SurfaceModel::phong);
  EXPECT_EQ(first.base_color, glm::vec3(1, 0, 0));
  EXPECT_EQ(first.emissive, glm::vec3(0));
  EXPECT_FALSE(first.base_color_map || first.emissive_map || first.metallic_roughness_map);
  EXPECT_FALSE(first.normal_map || first.occlusion_map);
  EXPECT_TRUE(scene.meshes[0].colors.empty());
  // What passes through glass stays.
  EXPECT_TRUE(second.base_color_map);
  EXPECT_FALSE(scene.meshes[1].colors.empty());
  EXPECT_EQ(second.specular, glm::vec3(0));
}

TEST(Looks, EmissionOfALostPictureIsLeftOut) {
  Scene scene = scene_of({shining(glm::vec3(1.0f)), shining(glm::vec3(1.0f))});
  leave_out_blank_emission(scene);
  EXPECT_EQ(scene.materials[0].emissive, glm::vec3(0));
  EXPECT_EQ(scene.materials[1].emissive, glm::vec3(0));
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(Looks, LampsShine) {
  for (const Material& other : {shining(glm::vec3(0.0f)), shining({1, 1, 0.5f}), shining(glm::vec3(4.0f)),
                                shining(glm::vec3(1.0f), 0)}) {
    Scene scene = scene_of({shining(glm::vec3(1.0f)), other});
    leave_out_blank_emission(scene);
    EXPECT_EQ(scene.materials[0].emissive, glm::vec3(1));
    EXPECT_TRUE(scene.warnings.empty());
  }
  Scene empty;
  leave_out_blank_emission(empty);
  EXPECT_TRUE(empty.warnings.empty());
}

}  // namespace
}  // namespace tenebra::stage
