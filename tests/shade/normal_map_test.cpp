// Normal maps and what stands beside them: how they bend normals and what stays geometric.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "shade/shading.h"
#include "support/hand_made.h"

namespace tenebra {
namespace {

using glm::vec3;

/// A picture of one colour.
TextureImage flat_image(glm::ivec3 rgb) {
  TextureImage image{"flat", 2, 2, {}};
  for (int i = 0; i < 4; ++i)
    for (const int value : {rgb.x, rgb.y, rgb.z, 255}) image.rgba.push_back(static_cast<std::uint8_t>(value));
  return image;
}

/// A quad before a camera that looks along -z; its picture stands upright unless told otherwise.
class NormalMap : public ::testing::Test {
protected:
  NormalMap() {
    Mesh mesh;
    mesh.positions = {{-9, -9, -5}, {9, -9, -5}, {9, 9, -5}, {-9, 9, -5}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texture_coordinates[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.materials = {0, 0};
    scene.meshes.push_back(mesh);
    scene.nodes.push_back({.mesh = 0});
    scene.materials.push_back(make_material(vec3(1)));
    scene.materials[0].normal_map.image = 0;
    scene.images = {flat_image({204, 153, 230})};  // x 0.6, y 0.2, z 0.8
  }

  static vec3 stored() { return {2 * 204 / 255.0f - 1, 2 * 153 / 255.0f - 1, 2 * 230 / 255.0f - 1}; }

  /// The quad's colour by `light`.
  vec3 shaded(const std::vector<shade::DrawnLight>& light, vec3 ambient = vec3(0), float irradiance = -1,
              SimdLevel simd = SimdLevel::automatic) const {
    FrameGeometry geometry;
    evaluate_frame(scene, -1, 0, geometry);
    const shade::SurfaceTable surfaces(scene);
    const std::vector<std::uint32_t> ids{0, 1};
    const std::vector<glm::vec2> places{{4.5f, 4.5f}, {3.5f, 3.5f}};
    const std::vector<float> arriving(2, irradiance);
    std::vector<shade::LightFactors> factors(light.size());
    if (irradiance >= 0) factors[0].irradiance = arriving;
    std::vector<shade::ShadedSample> out;
    shade::shade_samples({geometry, orthographic_view({0, 0, 0}, 0.25f, 8, 8), surfaces, smooth_terminator},
                         {.lights = light, .ambient_light = ambient, .simd = simd},
                         {ids, places, factors, {}}, out);
    EXPECT_EQ(out[0].color, out[1].color);
    return out[0].color;
  }

  /// A sun that shines from `towards`, and what a white surface facing it shows.
  static std::vector<shade::DrawnLight> sun(vec3 towards) {
    WorldLight placed;
    placed.direction = -glm::normalize(towards);
    return {{make_light(LightType::directional, 3.14159265f), placed}};
  }

  /// Light from the right, above and the front finds the normal.
  vec3 found_normal() const {
    const float x = shaded(sun({0.6f, 0, 0.8f})).x, y = shaded(sun({0, 0.6f, 0.8f})).x,
                z = shaded(sun({0, 0, 1})).x;
    return {(x - 0.8f * z) / 0.6f, (y - 0.8f * z) / 0.6f, z};
  }

  Scene scene;
  bool smooth_terminator = true;
};

void expect_near(vec3 a, vec3 b, double tolerance = 1e-4) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << c;
}

TEST_F(NormalMap, BendsTheNormalToTheRightAndUpInThePicture) {
  const vec3 expected = glm::normalize(stored());
  expect_near(found_normal(), expected);
  scene.meshes[0].normals.clear();  // the face normal
  expect_near(found_normal(), expected);
  scene.materials[0].normal_scale = 0.5f;
  expect_near(found_normal(), glm::normalize(stored() * vec3(0.5f, 0.5f, 1)));
}

TEST_F(NormalMap, TurnsAndMirrorsWithThePicture) {
  const vec3 n = glm::normalize(stored());
  const auto with = [&](std::vector<glm::vec2> coordinates) {
    scene.meshes[0].texture_coordinates[0] = std::move(coordinates);
    return found_normal();
  };
  expect_near(with({{1, 1}, {0, 1}, {0, 0}, {1, 0}}), {-n.x, n.y, n.z});  // left and right
  expect_near(with({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), {n.x, -n.y, n.z});  // top and bottom
  expect_near(with({{0, 0}, {0, 1}, {1, 1}, {1, 0}}), {-n.y, n.x, n.z});  // a quarter turn to the left
  scene.materials[0].normal_map.transform = {-1, 0, 0, 1, 0, 0};          // as the first, by the map
  expect_near(with({{0, 1}, {1, 1}, {1, 0}, {0, 0}}), {-n.x, n.y, n.z});
}

TEST_F(NormalMap, TheOtherWindingOrABackSeesTheSameReliefFromBehind) {
  const vec3 n = glm::normalize(stored());
  Mesh& mesh = scene.meshes[0];
  mesh.normals.clear();
  mesh.triangles = {{2, 1, 0}, {3, 2, 0}};  // seen from behind: its picture is mirrored, bumps are dents
  expect_near(found_normal(), {-n.x, -n.y, n.z});
  mesh.normals.assign(4, {0, 0, -1});
  expect_near(found_normal(), {-n.x, -n.y, n.z});
  mesh.normals.assign(4, {0, 0, 1});  // normals that say that this is the front
  expect_near(found_normal(), n);
}

TEST_F(NormalMap, TangentsOfTheFileDecide) {
  const vec3 n = glm::normalize(stored());
  scene.meshes[0].tangents.assign(4, {0, 1, 0, 1});
  expect_near(found_normal(), {-n.y, n.x, n.z});
  scene.meshes[0].tangents.assign(4, {0, 1, 0, -1});
  expect_near(found_normal(), {n.y, n.x, n.z});
  scene.nodes[0].scale = {-1, 1, 1};  // a mirror turns the handedness of what it shows
  expect_near(found_normal(), {-n.y, n.x, n.z});
}

TEST_F(NormalMap, NoLightComesFromBelowTheSurface) {
  scene.images = {flat_image({255, 128, 140})};  // nearly along the surface
  for (const bool smooth : {false, true}) {
    smooth_terminator = smooth;
    EXPECT_GT(shaded(sun({1, 0, 0.01f})).x, 0.9f);
    EXPECT_EQ(shaded(sun({1, 0, -0.01f})), vec3(0));
  }
}

TEST_F(NormalMap, WithoutADirectionTheNormalStays) {
  scene.meshes[0].texture_coordinates[0].assign(4, {0.5f, 0.5f});
  expect_near(found_normal(), {0, 0, 1});
}

TEST_F(NormalMap, IrradianceTurnsWithTheNormal) {
  std::vector<shade::DrawnLight> light = sun({0.8f, 0, 0.6f});
  light[0].area = make_sun(glm::vec3(0.8f, 0, 0.6f), 3.0).value();
  const float bent = shaded(light, vec3(0), 0.3f).x;
  scene.materials[0].normal_map.image = -1;
  const float before = shaded(light, vec3(0), 0.3f).x;
  ASSERT_GT(before, 0);
  EXPECT_NEAR(bent / before, glm::dot(glm::normalize(stored()), vec3(0.8f, 0, 0.6f)) / 0.6f, 1e-4);
}

TEST_F(NormalMap, OcclusionDimsAmbientLightAlone) {
  Material& m = scene.materials[0];
  m.normal_map.image = -1;
  m.occlusion_map.image = 0;
  m.occlusion_strength = 0.5f;
  const float left = 1 + 0.5f * (204 / 255.0f - 1);
  for (const SurfaceModel model : {SurfaceModel::phong, SurfaceModel::metallic_roughness}) {
    m.model = model;
    m.occlusion_map.image = -1;
    const vec3 ambient = shaded({}, vec3(1)), direct = shaded(sun({0, 0, 1}));
    m.occlusion_map.image = 0;
    expect_near(shaded({}, vec3(1)), left * ambient);
    EXPECT_EQ(shaded(sun({0, 0, 1})), direct);
  }
}

TEST_F(NormalMap, AShareOfReflectanceAndAMapOfExponentsCount) {
  Material& m = scene.materials[0];
  m.normal_map.image = -1;
  m.model = SurfaceModel::metallic_roughness;
  m.base_color = vec3(0);
  m.roughness = 0.5f;
  const vec3 all = shaded(sun({0, 0, 1}));
  m.specular_share = 0.25f;
  expect_near(shaded(sun({0, 0, 1})), 0.25f * all);
  m.dielectric = vec3(0.08f, 0.04f, 0);
  expect_near(shaded(sun({0, 0, 1})), 0.25f * vec3(2, 1, 0) * all);
  m.specular_map.image = 0;
  const vec3 color = vec3(204, 153, 230) / 255.0f;
  scene.transfer = Transfer::display;
  expect_near(shaded(sun({0, 0, 1})), 0.25f * vec3(2, 1, 0) * color * all);
  m = make_material(vec3(0));
  m.specular = vec3(1);
  m.phong_exponent = 10;
  const float plain = shaded(sun({0.6f, 0, 0.8f})).x;
  m.exponent_map.image = 0;
  EXPECT_NEAR(shaded(sun({0.6f, 0, 0.8f})).x, std::pow(plain, 204 / 255.0), 1e-4);
}

TEST_F(NormalMap, AllVectorLevelsGiveTheSameBits) {
  Material& m = scene.materials[0];
  m.model = SurfaceModel::metallic_roughness;
  m.occlusion_map.image = 0;
  m.specular_share_map.image = 0;
  std::vector<shade::DrawnLight> area = sun({0.3f, 0.5f, 0.6f});
  area[0].area = make_sun(vec3(0.3f, 0.5f, 0.6f), 3.0).value();
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    EXPECT_EQ(shaded(sun({0.3f, 0.5f, 0.6f}), vec3(0.2f), -1, level),
              shaded(sun({0.3f, 0.5f, 0.6f}), vec3(0.2f)));
    EXPECT_EQ(shaded(area, vec3(0.2f), 0.3f, level), shaded(area, vec3(0.2f), 0.3f));
  }
}

}  // namespace
}  // namespace tenebra
