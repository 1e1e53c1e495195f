// Tangents that a file lacks.
#include "stage/tangents.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tenebra::stage {
namespace {

using glm::vec3;
using glm::vec4;

/// Part of a cylinder around the y axis, in strips of two triangles, the picture wrapped around it.
Scene cylinder(bool share_vertices) {
  Mesh mesh;
  const auto add = [&](int column, int row) {
    const float angle = 0.3f * static_cast<float>(column);
    mesh.normals.emplace_back(std::sin(angle), 0, std::cos(angle));
    mesh.positions.push_back(mesh.normals.back() + vec3(0, row, 0));
    mesh.texture_coordinates[0].emplace_back(static_cast<float>(column), 1.0f - static_cast<float>(row));
    return static_cast<std::uint32_t>(mesh.positions.size()) - 1;
  };
  std::uint32_t low = add(0, 0), high = add(0, 1);
  for (int column = 1; column < 5; ++column) {
    if (!share_vertices && column > 1) low = add(column - 1, 0), high = add(column - 1, 1);
    const std::uint32_t next_low = add(column, 0), next_high = add(column, 1);
    mesh.triangles.insert(mesh.triangles.end(), {{low, next_low, next_high}, {low, next_high, high}});
    low = next_low, high = next_high;
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  Scene scene;
  scene.meshes.push_back(mesh);
  scene.materials.emplace_back().normal_map.image = 0;
  return scene;
}

TEST(Tangents, LieAlongASmoothSurfaceAndAreMeansOfTrianglesThatMeet) {
  for (const bool share : {true, false}) {
    Scene scene = cylinder(share);
    add_tangents(scene);
    const Mesh& mesh = scene.meshes[0];
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const vec3 n = mesh.normals[v], around(n.z, 0, -n.x);
      EXPECT_NEAR(glm::length(vec3(mesh.tangents[v]) - around), 0, 1e-6) << v;
      EXPECT_EQ(mesh.tangents[v].w, 1.0f);
    }
  }
}

TEST(Tangents, ThoseOfTheFileStayAndOthersAreFilledIn) {
  Scene scene = cylinder(true);
  scene.meshes[0].tangents.assign(scene.meshes[0].positions.size(), vec4(0));
  scene.meshes[0].tangents[3] = {0, 1, 0, -1};
  add_tangents(scene);
  EXPECT_EQ(scene.meshes[0].tangents[3], vec4(0, 1, 0, -1));
  EXPECT_NE(scene.meshes[0].tangents[4], vec4(0));
}

TEST(Tangents, WhereMirroredCoordinatesMeetNoneIsGiven) {
  Scene scene = cylinder(true);
  for (glm::vec2& at : scene.meshes[0].texture_coordinates[0]) at.x = std::abs(at.x - 2);
  add_tangents(scene);
  const auto& tangents = scene.meshes[0].tangents;
  EXPECT_EQ(tangents[2].w, -1.0f);
  EXPECT_EQ(tangents[4], vec4(0));  // column 2
  EXPECT_EQ(tangents[6].w, 1.0f);
}

TEST(Tangents, FlatTrianglesAndThoseWithoutAMapGetNone) {
  Scene flat = cylinder(true);
  flat.meshes[0].normals.clear();
  Scene plain = cylinder(true);
  plain.materials[0].normal_map.image = -1;
  Scene without = cylinder(true);
  without.meshes[0].texture_coordinates[0].clear();
  for (Scene* scene : {&flat, &plain, &without}) {
    add_tangents(*scene);
    EXPECT_TRUE(scene->meshes[0].tangents.empty());
  }
}

TEST(Tangents, OddNumbersAreNoDirections) {
  Scene scene = cylinder(true);
  scene.meshes[0].positions[2].x = NAN;
  scene.meshes[0].texture_coordinates[0].assign(scene.meshes[0].positions.size(), {0.5f, 0.5f});
  add_tangents(scene);
  for (const vec4& tangent : scene.meshes[0].tangents) EXPECT_EQ(tangent, vec4(0));
}

}  // namespace
}  // namespace tenebra::stage
