// Where sun is counted: points of faces, cells and lists.
#include <gtest/gtest.h>

#include "sun_scenes.h"

namespace tenebra::sun {
namespace {

using testing::frame_of, testing::wall_scene;

/// The least weight of a corner of its triangle in a point on it; the weights sum to 1.
double least_weight(const FrameGeometry& frame, std::uint32_t triangle, const glm::dvec3& p) {
  const auto corner = [&](int k) { return glm::dvec3(frame.positions[frame.triangles[triangle][k]]); };
  const double whole = glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
  double least = 1;
  const glm::dvec3 up = glm::cross(corner(1) - corner(0), corner(2) - corner(0)) / whole;
  for (int k = 0; k < 3; ++k)
    least =
        std::min(least, glm::dot(glm::cross(corner((k + 1) % 3) - p, corner((k + 2) % 3) - p), up) / whole);
  return least;
}

TEST(SunReceivers, PointsLieInsideTheirFacesEvenly) {
  const Scene scene = wall_scene();
  const FrameGeometry frame = frame_of(scene);
  const Receivers faces = face_receivers(scene, frame, {.per_face = 10}).value();  // 16
  ASSERT_EQ(faces.list.size(), 4u);
  ASSERT_EQ(faces.positions.size(), 64u);
  std::size_t point = 0;
  for (const Receiver& receiver : faces.list) {
    glm::dvec3 mean(0.0);
    for (; point < receiver.end; ++point) {
      EXPECT_EQ(faces.triangles[point], receiver.triangle);
      EXPECT_GT(least_weight(frame, receiver.triangle, faces.positions[point]), 0.08);
      mean += faces.positions[point] / 16.0;
    }
    EXPECT_NEAR(glm::length(mean - receiver.centre), 0, 1e-12);
  }
  EXPECT_EQ(faces.list[0].area_m2, 800);
  EXPECT_EQ(face_receivers(scene, frame, {.per_m2 = 0.1}).value().list[2].end,
            81u * 2 + 4);  // 80 and 4 points
}

TEST(SunReceivers, ChoosesFaces) {
  const Scene scene = wall_scene();
  const FrameGeometry frame = frame_of(scene);
  EXPECT_EQ(face_receivers(scene, frame, {.upward = true}).value().list.size(), 2u);
  EXPECT_NE(
      face_receivers(scene, frame, {.nodes = {"nowhere"}}).error().message.find("no node called nowhere"),
      std::string::npos);
  EXPECT_NE(face_receivers(scene, frame, {.materials = {"x"}}).error().message.find("no material called x"),
            std::string::npos);
}

TEST(SunReceivers, CellsLieAtMultiplesOfTheirSizeInTheFile) {
  const Scene scene = wall_scene({690000.25, 5330000.25, 100});
  const Receivers cells = ground_receivers(frame_of(scene), scene.frame, 101.5, 10).value();
  EXPECT_EQ(cells.grid.columns, 5);  // 689980.25 to 690020.25
  EXPECT_EQ(cells.grid.rows, 5);
  ASSERT_EQ(cells.list.size(), 25u);
  const glm::dvec3 first = scene.frame.to_file(cells.list[0].centre),
                   last = scene.frame.to_file(cells.list[24].centre);
  EXPECT_EQ(first, glm::dvec3(689985, 5330025, 101.5));  // north-west
  EXPECT_EQ(last, glm::dvec3(690025, 5329985, 101.5));
  EXPECT_FALSE(ground_receivers(frame_of(scene), scene.frame, 0, 1e-3));  // 1.6e9 cells
}

TEST(SunReceivers, PointsOfAFileKeepTheirOrderAndDigits) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "p.csv",
                      "z,y,x,nx,ny,nz\n1,5330000.125,690001,0,0,1\n2,5330000,690000,0,1,0\n");
  const Scene scene = wall_scene({690000, 5330000, 0});
  const Receivers points = read_receivers(folder / "p.csv", scene.frame).value();
  ASSERT_EQ(points.list.size(), 2u);
  EXPECT_EQ(scene.frame.to_file(points.list[0].centre), glm::dvec3(690001, 5330000.125, 1));
  EXPECT_EQ(points.normals[0], glm::vec3(0, 1, 0));
  EXPECT_EQ(points.normals[1], glm::vec3(0, 0, -1));
  testing::write_text(folder / "p.csv", "x,y,z,nx\n1,2,3,4\n");
  EXPECT_NE(read_receivers(folder / "p.csv", scene.frame).error().message.find("a part of the columns nx"),
            std::string::npos);
}

}  // namespace
}  // namespace tenebra::sun
