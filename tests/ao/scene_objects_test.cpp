// Which triangles move as one, which objects share a shape, and which geometry is left to rays.
#include "ao/objects/scene_objects.h"

#include "ao_case.h"
#include "formats/import_scene.h"

namespace tenebra {
namespace {

using testing::box_mesh;
using testing::SceneMaker;

ao::SceneObjects found(const Scene& scene, double time_s = 0) {
  FrameGeometry geometry;
  evaluate_frame(scene, scene.clips.empty() ? -1 : 0, time_s, geometry);
  return ao::find_objects(scene, geometry);
}

TEST(Objects, WhatNoClipMovesStands) {
  SceneMaker make;
  const int still = make.add(box_mesh({0, 0, 0}, {1, 1, 1}));
  make.animate(still, ChannelPath::translation, {0, 0, 0}, {0, 0, 0});  // a channel that changes nothing
  const ao::SceneObjects objects = found(make.scene);
  EXPECT_TRUE(objects.objects.empty());
  EXPECT_EQ(objects.standing.triangles.size(), 12u);
  EXPECT_EQ(objects.owners[11].object, ao::TriangleOwner::standing);
  EXPECT_EQ(objects.owners[11].triangle, 11u);
}

TEST(Objects, MeshesBelowOneMovingNodeAreOneObject) {
  SceneMaker make;
  const int body = make.add(box_mesh({0, 0, 0}, {1, 1, 1}));
  make.place(0, {2, 0, 0}, make.place(-1, {0, 3, 0}, body));
  const int arm = make.place(0, {4, 0, 0}, body);
  make.move(body, {1, 0, 0});
  make.move(arm, {0, 1, 0});
  const ao::SceneObjects objects = found(make.scene, 0.25);
  ASSERT_EQ(objects.objects.size(), 2u);
  EXPECT_EQ(objects.shapes[static_cast<std::size_t>(objects.objects[0].shape)].triangles.size(), 24u);
  EXPECT_EQ(objects.shapes[static_cast<std::size_t>(objects.objects[1].shape)].triangles.size(), 12u);
  EXPECT_EQ(objects.owners[12].object, 0) << "the mesh below";
  EXPECT_EQ(objects.owners[24].object, 1) << "the arm moves by itself";
}

TEST(Objects, ShapesPlacedInTheWorldAreTheFramesTriangles) {
  SceneMaker make;
  const int body = make.add(box_mesh({0, 0, 0}, {1, 2, 3}));
  make.scene.nodes[0].scale = {-2, 1, 0.5};  // mirrored and stretched, by itself
  make.scene.nodes[0].rotation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  make.place(0, {2, 0, 0}, body);
  make.scene.nodes[1].rotation = glm::angleAxis(0.3, glm::dvec3(0, 1, 0));
  make.move(body, {1, 5, 0});
  FrameGeometry geometry;
  evaluate_frame(make.scene, 0, 0.5, geometry);
  const ao::SceneObjects objects = ao::find_objects(make.scene, geometry);
  ASSERT_EQ(objects.objects.size(), 1u);
  const ao::MovingObject& object = objects.objects[0];
  const ao::ObjectShape& shape = objects.shapes[0];
  for (std::size_t id = 0; id < geometry.triangles.size(); ++id) {
    ASSERT_EQ(objects.owners[id].object, 0);
    glm::dvec3 placed(0), frame(0);  // centroids: a mirrored frame turns the corners' order round
    for (int k = 0; k < 3; ++k) {
      const glm::uvec3 t = shape.triangles[objects.owners[id].triangle];
      placed += glm::dvec3(object.to_world * glm::dvec4(glm::dvec3(shape.positions[t[k]]), 1.0)) / 3.0;
      frame += glm::dvec3(geometry.positions[geometry.triangles[id][k]]) / 3.0;
    }
    EXPECT_LT(glm::length(placed - frame), 1e-5) << id;
  }
  EXPECT_NEAR(object.scale, 2, 1e-9);
}

TEST(Objects, InstancesShareAShapeWhateverTheirTurnAndSize) {
  SceneMaker make;
  make.add(box_mesh({0, 0, 0}, {1, 1, 1}));
  make.place(0, {5, 0, 0});
  make.scene.nodes[1].rotation = glm::angleAxis(1.0, glm::dvec3(0, 0, 1));
  make.scene.nodes[1].scale = glm::dvec3(3);
  make.place(0, {9, 0, 0});
  make.scene.nodes[2].scale = {1, 2, 1};  // of other proportions: a shape of its own
  for (int node = 0; node < 3; ++node) make.move(node, {0, 1, 0});
  const ao::SceneObjects objects = found(make.scene);
  ASSERT_EQ(objects.objects.size(), 3u);
  EXPECT_EQ(objects.shapes.size(), 2u);
  EXPECT_EQ(objects.objects[0].shape, objects.objects[1].shape);
  EXPECT_NE(objects.objects[0].shape, objects.objects[2].shape);
}

TEST(Objects, MeshesThatDeformAreNamed) {
  SceneMaker make;
  for (const char* name : {"morph.aff:3", "morph.aff:3", "blob"}) {
    Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
    mesh.source = name;
    mesh.shapes = {{0, mesh.positions, {}}};
    make.add(mesh);
  }
  const ao::SceneObjects objects = found(make.scene);
  EXPECT_EQ(objects.deforming.size(), 36u);
  EXPECT_EQ(objects.deforming_names, (std::vector<std::string>{"morph.aff:3", "blob"}));
  EXPECT_TRUE(objects.objects.empty());
}

TEST(Objects, WhatIsStretchedIsNotRigidForAWhile) {
  SceneMaker make;
  const int balloon = make.add(box_mesh({0, 0, 0}, {1, 1, 1}));
  make.animate(balloon, ChannelPath::scale, {2, 2, 2}, {4, 2, 2});
  make.scene.nodes[0].scale = glm::dvec3(2);
  const int jitter = make.place(0, {8, 0, 0});
  make.animate(jitter, ChannelPath::scale, {1, 1, 1}, {1.0000001, 1, 1});  // an exporter's noise
  ao::SceneObjects objects = found(make.scene);
  ASSERT_EQ(objects.objects.size(), 2u);
  EXPECT_EQ(objects.shapes.size(), 1u);
  EXPECT_TRUE(objects.objects[0].rigid);
  FrameGeometry geometry;
  evaluate_frame(make.scene, 0, 1, geometry);
  ASSERT_TRUE(ao::move_objects(make.scene, geometry, objects));
  EXPECT_FALSE(objects.objects[0].rigid);
  EXPECT_NEAR(objects.objects[0].largest_scale, 4, 1e-9);
  EXPECT_TRUE(objects.objects[1].rigid);
}

TEST(Objects, FollowTheFrameUntilWhatStoodMoves) {
  SceneMaker make;
  const int body = make.add(box_mesh({0, 0, 0}, {1, 1, 1}));
  make.add(box_mesh({0, 0, 0}, {1, 1, 1}), {5, 0, 0});
  make.move(body, {8, 0, 0});
  ao::SceneObjects objects = found(make.scene);
  FrameGeometry geometry;
  evaluate_frame(make.scene, 0, 0.5, geometry);
  EXPECT_TRUE(ao::move_objects(make.scene, geometry, objects));
  EXPECT_EQ(objects.objects[0].to_world[3], glm::dvec4(4, 0, 0, 1));
  make.scene.nodes[1].translation.x = 6;
  evaluate_frame(make.scene, 0, 0.5, geometry);
  EXPECT_FALSE(ao::move_objects(make.scene, geometry, objects));
}

TEST(Objects, RobotsOfTheCityShareTheirLimbs) {
  auto scene = formats::import_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / "city.glb");
  ASSERT_TRUE(scene);
  const ao::SceneObjects objects = found(*scene);
  EXPECT_EQ(objects.objects.size(), 130u) << "ten robots of thirteen limbs";
  EXPECT_EQ(objects.shapes.size(), 8u);
  EXPECT_TRUE(objects.deforming.empty());
}

}  // namespace
}  // namespace tenebra
