// What new vertices have, and input that has no sense.
#include <gtest/gtest.h>

#include <limits>

#include "stage/cutout/cards.h"
#include "stage/cutout/cutout.h"

namespace tenebra::testing {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Two joints, a morph target, two shapes' worth of positions; every value linear in the card's x and y.
Scene dressed_card() {
  Scene scene = card(leaf(64));
  Mesh& mesh = scene.meshes[0];
  mesh.texture_coordinates[1] = {{0, 0}, {2, 0}, {2, 3}, {0, 3}};
  mesh.colors = {{0, 0, 1, 1}, {1, 0, 1, 1}, {1, 1, 1, 1}, {0, 1, 1, 1}};
  mesh.joints.assign(4, glm::u16vec4(3, 5, 0, 0));
  mesh.weights = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}};
  mesh.morph_targets.push_back({{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 1}}, {}});
  mesh.shapes.push_back({0.0, mesh.positions, mesh.normals});
  mesh.shapes.push_back({1.0, {{0, 0, 0}, {0, 0, 4}, {0, 0, 4}, {0, 0, 0}}, {}});
  return scene;
}

TEST(CutMesh, NewVerticesHaveEverything) {
  Scene scene = dressed_card();
  stage::cut_out_masks(scene);
  const Mesh& mesh = scene.meshes[0];
  const std::size_t n = mesh.positions.size();
  ASSERT_GT(n, 50u);
  ASSERT_EQ(mesh.normals.size(), n);
  ASSERT_EQ(mesh.colors.size(), n);
  ASSERT_EQ(mesh.joints.size(), n);
  ASSERT_EQ(mesh.weights.size(), n);
  ASSERT_EQ(mesh.shapes[0].normals.size(), n);
  ASSERT_TRUE(mesh.shapes[1].normals.empty());
  for (std::size_t v = 0; v < n; ++v) {
    const glm::vec3 p = mesh.positions[v];
    EXPECT_EQ(mesh.normals[v], glm::vec3(0, 0, 1));
    EXPECT_NEAR(glm::distance(mesh.texture_coordinates[0][v], glm::vec2(p)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(mesh.texture_coordinates[1][v], glm::vec2(2, 3) * glm::vec2(p)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(mesh.colors[v], glm::vec4(p.x, p.y, 1, 1)), 0, 1e-6);
    float third = 0, fifth = 0;
    for (int k = 0; k < 4; ++k) {
      if (mesh.joints[v][k] == 3) third += mesh.weights[v][k];
      if (mesh.joints[v][k] == 5) fifth += mesh.weights[v][k];
    }
    EXPECT_NEAR(third, 1 - p.x, 1e-6);
    EXPECT_NEAR(fifth, p.x, 1e-6);
    EXPECT_NEAR(mesh.morph_targets[0].positions[v].z, p.x + p.y, 1e-6);
    EXPECT_EQ(mesh.shapes[0].positions[v], p);
    EXPECT_NEAR(mesh.shapes[1].positions[v].z, 4 * p.x, 1e-6);
  }
}

TEST(CutMesh, MoreThanEightJointsAreSaid) {
  Scene scene = card(leaf(64));
  Mesh& mesh = scene.meshes[0];
  for (std::uint16_t v = 0; v < 4; ++v) {
    const auto j = static_cast<std::uint16_t>(4 * v);
    mesh.joints.emplace_back(j, j + 1, j + 2, j + 3);
    mesh.weights.emplace_back(0.4f, 0.3f, 0.2f, 0.1f);
  }
  stage::cut_out_masks(scene);
  ASSERT_EQ(mesh.more_weights.size(), mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    float sum = 0;
    for (int k = 0; k < 4; ++k) sum += mesh.weights[v][k] + mesh.more_weights[v][k];
    EXPECT_NEAR(sum, 1, 1e-5);
  }
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("more than eight joints"), std::string::npos) << scene.warnings[0];
}

std::size_t left_of(Scene scene) {
  return stage::cut_out_masks(scene).left;
}

TEST(CutMesh, WithoutAlphaNothingChanges) {
  Scene solid = card(picture(8, 8, [](int, int) { return 1.0; }));
  const std::vector<glm::uvec3> triangles = solid.meshes[0].triangles;
  EXPECT_EQ(left_of(solid), 2u);
  stage::cut_out_masks(solid);
  EXPECT_EQ(solid.meshes[0].triangles, triangles);
  EXPECT_EQ(solid.meshes[0].positions.size(), 4u);
  EXPECT_EQ(left_of(card(picture(8, 8, [](int, int) { return 0.2; }))), 0u);
  Scene no_cutoff = card(leaf(32));
  no_cutoff.materials[0].alpha_cutoff = 0;
  EXPECT_EQ(left_of(no_cutoff), 2u);
  Scene all_gone = card(leaf(32));
  all_gone.materials[0].alpha_cutoff = 1.5f;
  EXPECT_EQ(left_of(all_gone), 0u);
}

TEST(CutMesh, OtherMaterialsStay) {
  Scene scene = card(leaf(32));
  scene.materials.push_back(scene.materials[0]);
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.meshes[0].materials[1] = 1;
  const auto counts = stage::cut_out_masks(scene);
  EXPECT_EQ(counts.triangles, 1u);
  EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::blend);
  EXPECT_EQ(scene.meshes[0].triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(scene.meshes[0].materials[0], 0u);
}

TEST(CutMesh, NonsenseIsKeptOrLeftOutWhole) {
  Scene no_image = card(leaf(32));
  no_image.images.clear();
  EXPECT_EQ(left_of(no_image), 2u);
  Scene no_number = card(leaf(32));
  no_number.meshes[0].texture_coordinates[0][1] = {nan, 0};
  EXPECT_GE(left_of(no_number), 1u);  // triangle 0 has the first pixel's alpha, that is none
  Scene far_off = card(leaf(32), {0, 0}, {1e30f, 1e30f});
  EXPECT_EQ(left_of(far_off), 0u);
  Scene no_coordinates = card(leaf(32));
  no_coordinates.meshes[0].texture_coordinates[0].clear();
  EXPECT_LE(left_of(no_coordinates), 2u);
  Scene no_cutoff = card(leaf(32));
  no_cutoff.materials[0].alpha_cutoff = nan;
  EXPECT_EQ(left_of(no_cutoff), 2u);
  Scene point = card(leaf(32), {0.5f, 0.5f}, {0.5f, 0.5f});
  EXPECT_EQ(left_of(point), 2u);
  Scene flat = card(leaf(32));
  flat.meshes[0].positions.assign(4, glm::vec3(1.0f));
  EXPECT_GT(left_of(flat), 2u);
}

TEST(CutMesh, CoordinatesOnOneLineAreCutToo) {
  // Alpha rises with u; v is constant: the card ends at u = 0.5.
  Scene scene = card(picture(256, 4, [](int x, int) { return x / 255.0; }), {0, 0.5f}, {1, 0.5f});
  scene.materials[0].base_color_map.wrap_u = Wrap::clamp_to_edge;
  stage::cut_out_masks(scene);
  float least = 1;
  for (const glm::uvec3& t : scene.meshes[0].triangles)
    for (int k = 0; k < 3; ++k) least = std::fmin(least, scene.meshes[0].positions[t[k]].x);
  EXPECT_NEAR(least, 0.5f, 0.01f);
}

TEST(CutMesh, VertexAlphaCutsStraight) {
  Scene scene = card(leaf(32));
  scene.images.clear();
  scene.meshes[0].colors = {{1, 1, 1, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};
  EXPECT_LE(stage::cut_out_masks(scene).left, 6u);
  for (const glm::uvec3& t : scene.meshes[0].triangles)
    for (int k = 0; k < 3; ++k) EXPECT_GE(scene.meshes[0].positions[t[k]].x, 0.499f);
}

TEST(CutMesh, VertexAlphaTimesTexture) {
  Scene scene = card(noise(32, 32, 3)), whole = scene;
  scene.meshes[0].colors = {{1, 1, 1, 0.2f}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0.2f}};
  const Mesh& mesh = scene.meshes[0];
  stage::cut_out_masks(scene);
  ASSERT_GT(mesh.triangles.size(), 100u);
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 middle = (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0f;
    const double texel = alpha_over(whole, glm::vec2(middle)) + 0.5;
    EXPECT_GT(texel * (0.2 + 0.8 * middle.x), 0.5 - 0.12);
  }
}

TEST(CutMesh, LimitMakesItCoarserAndSaysSo) {
  Scene scene = card(noise(256, 256, 4));
  const auto counts = stage::cut_out_masks(scene, {.most_added = 1000});
  EXPECT_LE(counts.left, 1002u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("card: alpha is cut out to"), std::string::npos) << scene.warnings[0];
  Scene instances = card(noise(64, 64, 4));
  for (int i = 0; i < 9; ++i) instances.nodes.emplace_back().mesh = 0;
  const auto ten = stage::cut_out_masks(instances, {.most_added = 20000});
  EXPECT_EQ(ten.triangles, 20u);
  EXPECT_LE(ten.left, 20020u);
  EXPECT_EQ(instances.warnings.size(), 1u);
}

TEST(CutMesh, ManyRepeatsEnd) {
  Scene hundred = card(fence(64), {0, 0}, {100, 100});  // 35 million triangles at full fineness
  EXPECT_LE(stage::cut_out_masks(hundred, {.most_added = 50'000}).left, 50'002u);
  EXPECT_EQ(hundred.warnings.size(), 1u);
  Scene scene = card(leaf(16), {0, 0}, {1e5f, 1e5f});
  EXPECT_LE(stage::cut_out_masks(scene).left, 2u);
  EXPECT_EQ(scene.warnings.size(), 1u);
  Scene clamped = card(leaf(16), {-1e5f, -1e5f}, {1e5f, 1e5f});
  clamped.materials[0].base_color_map.wrap_u = clamped.materials[0].base_color_map.wrap_v =
      Wrap::clamp_to_edge;
  EXPECT_LE(stage::cut_out_masks(clamped).left, 300u);
  EXPECT_TRUE(clamped.warnings.empty());
}

}  // namespace
}  // namespace tenebra::testing
