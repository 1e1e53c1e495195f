// Where a camera is added for what is hard to frame: slender things, shells that are open to one side, rooms.
#include "stage/additions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "stage/box_scenes.h"

namespace tenebra::testing {
namespace {

/// Of the rays through the picture of the added camera: those that meet something, and its front.
struct Shown {
  double met = 0, fronts = 0;
};
Shown shown_of(const Scene& scene, std::size_t triangles) {
  constexpr int side = 40;
  const ViewRays view = evaluate_camera(scene, -1, 0, 0, side, side);
  const FrameGeometry frame = frame_at(scene);
  Shown shown;
  for (int i = 0; i < side * side; ++i) {
    const dvec3 direction =
        dvec3(view.d0) + (i % side + 0.5) * dvec3(view.dx) + (i / side + 0.5) * dvec3(view.dy);
    const auto way = first_hit(frame, triangles, dvec3(view.eye), direction);
    if (!way) continue;
    ++shown.met;
    for (std::size_t t = 0; t < triangles; ++t) {
      FrameGeometry one;
      one.positions = frame.positions;
      one.triangles = {frame.triangles[t]};
      if (first_hit(one, 1, dvec3(view.eye), direction) != way) continue;
      const dvec3 a(frame.positions[frame.triangles[t].x]), b(frame.positions[frame.triangles[t].y]),
          c(frame.positions[frame.triangles[t].z]);
      shown.fronts += glm::dot(glm::cross(b - a, c - a), direction) < 0;
      break;
    }
  }
  return {shown.met / (side * side), shown.fronts / (side * side)};
}

/// A box of 2 x 2 x length, turned by `turn`.
Scene rod(float length, const glm::quat& turn) {
  Scene scene = boxes({{{-1, -1, -length / 2}, {1, 1, length / 2}}});
  scene.nodes[0].rotation = turn;
  return scene;
}
const glm::quat along_x = glm::angleAxis(1.5707963f, glm::vec3(0, 1, 0)),
                upright = glm::angleAxis(1.5707963f, glm::vec3(1, 0, 0)),
                tilted = glm::angleAxis(0.8f, glm::normalize(glm::vec3(1, 1, 0.3f)));

/// Between the middle of the picture and an axis.
double off_axis_deg(const Scene& scene, const dvec3& axis) {
  const ViewRays view = evaluate_camera(scene, -1, 0, 0, 8, 8);
  const dvec3 middle = dvec3(view.d0) + 4.0 * dvec3(view.dx) + 4.0 * dvec3(view.dy);
  return std::acos(std::abs(glm::dot(glm::normalize(middle), axis))) * 180 / std::acos(-1.0);
}

TEST(AddedCamera, LooksAlongSlenderThingsUntilTheyFillThreeTenths) {
  struct Case {
    const char* name;
    glm::quat turn;
  };
  for (const Case& way : {Case{"along x", along_x}, Case{"along z", glm::quat(1, 0, 0, 0)},
                          Case{"upright", upright}, Case{"tilted", tilted}}) {
    for (const float times : {6.0f, 12.0f}) {
      Scene scene = rod(2 * times, way.turn);
      stage::add_missing_parts(scene);
      const FrameGeometry frame = frame_at(scene);
      expect_in_picture(scene, frame, 12);
      const BoxShares shares = shares_of(scene, frame, 12);
      EXPECT_GE(shares.subject, 0.3) << way.name << ", " << times << " times as long as wide";
      EXPECT_GE(off_axis_deg(scene, way.turn * glm::vec3(0, 0, 1)), 18) << way.name << ": its length is seen";
    }
  }
}

/// A box of 6 x 2.5 x 4 that is seen from inside, less some of its sides (two triangles each: back, front,
/// bottom, top, left, right), and a table in it.
enum Wall : std::size_t { back, front, bottom, top, left, right };
Mesh shell(const std::vector<Wall>& open = {}) {
  Mesh mesh;
  add_box(mesh, {-3, 0, -2}, {3, 2.5f, 2});
  std::vector<glm::uvec3> kept;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool left_out = std::any_of(open.begin(), open.end(), [&](Wall wall) { return t / 2 == wall; });
    const glm::uvec3 from = mesh.triangles[t];
    if (!left_out) kept.emplace_back(from.x, from.z, from.y);
  }
  mesh.triangles = kept;
  add_box(mesh, {-0.5f, 0, -0.5f}, {0.7f, 0.8f, 0.5f});
  return mesh;
}

bool is_in_the_room(const Scene& scene) {
  const dvec3 eye(evaluate_camera(scene, -1, 0, 0, 8, 8).eye);
  return std::abs(eye.x) < 3 && eye.y > 0 && eye.y < 2.5 && std::abs(eye.z) < 2;
}

TEST(AddedCamera, SeesAnOpenShellThroughItsOpening) {
  for (const Wall wall : {back, front, left, right, top}) {
    Scene scene = scene_of({shell({wall})});
    const std::size_t triangles = frame_at(scene).triangles.size();
    stage::add_missing_parts(scene);
    EXPECT_FALSE(is_in_the_room(scene)) << "wall " << wall;
    const Shown shown = shown_of(scene, triangles);
    EXPECT_GE(shown.fronts, 0.5 * shown.met) << "wall " << wall;
  }
}

/// The same room with walls 0.2 thick.
Scene thick_room() {
  return boxes({{{-3.2f, -0.2f, -2.2f}, {3.2f, 0, 2.2f}},
                {{-3.2f, 2.5f, -2.2f}, {3.2f, 2.7f, 2.2f}},
                {{-3.2f, 0, -2.2f}, {-3, 2.5f, 2.2f}},
                {{3, 0, -2.2f}, {3.2f, 2.5f, 2.2f}},
                {{-3, 0, -2.2f}, {3, 2.5f, -2}},
                {{-3, 0, 2}, {3, 2.5f, 2.2f}},
                {{-0.5f, 0, -0.5f}, {0.7f, 0.8f, 0.5f}}});
}

TEST(AddedCamera, StandsInAClosedRoom) {
  for (Scene scene : {scene_of({shell()}), thick_room()}) {
    const std::size_t triangles = frame_at(scene).triangles.size();
    const stage::AddedParts added = stage::add_missing_parts(scene);
    EXPECT_TRUE(is_in_the_room(scene));
    EXPECT_TRUE(added.camera && added.light && added.lamp);
    EXPECT_FALSE(added.floor) << "it has one";
    const Shown shown = shown_of(scene, triangles);
    EXPECT_EQ(shown.met, 1);
    EXPECT_GE(shown.fronts, 0.99);
    // The table is in the picture, and the lamp in the room: it shines on the floor beside the table.
    const ViewRays view = evaluate_camera(scene, -1, 0, 0, 40, 30);
    const glm::dmat3 rays(view.dx, view.dy, view.d0);
    const dvec3 table = glm::inverse(rays) * (dvec3(0.1, 0.8, 0) - dvec3(view.eye));
    EXPECT_TRUE(table.z > 0 && table.x > 0 && table.x < 40 * table.z && table.y > 0 &&
                table.y < 30 * table.z);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].type, LightType::point);
    const dvec3 lamp(evaluate_lights(scene, -1, 0).at(0).position), floor(2, 0, 1.5);
    EXPECT_NEAR(first_hit(frame_at(scene), triangles, lamp, floor - lamp).value_or(0), 1, 1e-6);
  }
}

/// A sphere of 2 * 24 * 12 triangles, inside out.
Mesh sphere_inside_out() {
  Mesh mesh;
  constexpr std::uint32_t columns = 24, rows = 12;
  for (std::uint32_t row = 0; row <= rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const double polar = std::acos(-1.0) * row / rows, angle = 2 * std::acos(-1.0) * column / columns;
      mesh.positions.emplace_back(std::sin(polar) * std::sin(angle), std::cos(polar),
                                  std::sin(polar) * std::cos(angle));
    }
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = row * columns + column, b = row * columns + (column + 1) % columns;
      mesh.triangles.emplace_back(a, b, a + columns);
      mesh.triangles.emplace_back(b, b + columns, a + columns);
    }
  mesh.materials.assign(mesh.triangles.size(), 0);
  return mesh;
}

TEST(AddedCamera, StaysOutsideOfWhatIsNoRoom) {
  const auto gets_lamp = [](Scene scene) { return stage::add_missing_parts(scene).lamp; };
  EXPECT_FALSE(gets_lamp(boxes({{{-3, 0, -2}, {3, 2.5f, 2}}}))) << "a solid box";
  EXPECT_FALSE(gets_lamp(scene_of({sphere_inside_out()})));
  EXPECT_FALSE(gets_lamp(scene_of({shell({top})}))) << "a box without a lid";
  EXPECT_FALSE(gets_lamp(boxes({{{-9, -0.1f, -9}, {9, 0, 9}}, {{-1, 0, -1}, {1, 1, 1}}})));
}

TEST(AddedCamera, InAClosedRoomLeavesTheFilesLightAlone) {
  Scene scene = scene_of({shell()});
  scene.lights.emplace_back();
  Node node;
  node.light = 0;
  node.translation = {0, 2, 0};
  scene.nodes.push_back(node);
  const stage::AddedParts added = stage::add_missing_parts(scene);
  EXPECT_TRUE(added.camera && !added.light && !added.lamp && !added.floor);
  EXPECT_TRUE(is_in_the_room(scene));
  EXPECT_EQ(scene.lights.size(), 1u);
}

}  // namespace
}  // namespace tenebra::testing
