// The files that other programs read: a coloured model, a plan, a GeoTIFF.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "io/input_file.h"
#include "math/srgb.h"
#include "sun/hours_model.h"
#include "sun/plan.h"
#include "sun_scenes.h"

namespace tenebra::sun {
namespace {

using testing::day_of_suns, testing::frame_of, testing::geometry_of, testing::wall_scene;

const glm::dvec3 far_off(690000, 5330000, 500);

/// A study of the far wall scene that owns what it refers to.
struct Case {
  Scene scene = wall_scene(far_off);
  FrameGeometry frame = frame_of(scene);
  Suns suns = day_of_suns(48, "2026-06-21", 60);
  Receivers receivers;
  SunHours hours;
  Study study{scene, frame, receivers, suns, hours};

  void count() { hours = sun_hours(geometry_of(frame), receivers, suns, {}).value(); }
};

struct FacesCase : Case {
  FacesCase() { receivers = face_receivers(scene, frame, {.upward = true}).value(), count(); }
};
struct GroundCase : Case {
  GroundCase() { receivers = ground_receivers(frame, scene.frame, 501, 10).value(), count(); }
};

TEST(SunOutputs, ColoursOfViridis) {
  const ColourScale scale{8};
  EXPECT_EQ(glm::ivec3(glm::round(255.0f * scale(0))), glm::ivec3(68, 1, 84));
  EXPECT_EQ(glm::ivec3(glm::round(255.0f * scale(4))), glm::ivec3(33, 145, 140));
  EXPECT_EQ(glm::ivec3(glm::round(255.0f * scale(8))), glm::ivec3(253, 231, 37));
  EXPECT_EQ(scale(-1), scale(0));
  EXPECT_EQ(scale(9), scale(8));
}

TEST(SunOutputs, TheModelHasColoursAndNumbers) {
  const FacesCase faces;
  const auto model = model_of(faces.study, scale_of(faces.study)).value();
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(formats::export_glb(model.scene, folder / "hours.glb", 30, model.additions).has_value());
  const std::string bytes = io::read_file(folder / "hours.glb", std::size_t{1} << 24).value();
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  const auto json = nlohmann::json::parse(bytes.substr(20, length));
  EXPECT_EQ(json["scenes"][0]["extras"]["zone"], "UTC");
  const std::size_t numbers = json["meshes"][0]["primitives"][0]["attributes"]["_SUN_HOURS"];
  EXPECT_EQ(json["accessors"][numbers]["min"][0], -1);  // the wall: only upward faces were asked about
  EXPECT_FLOAT_EQ(json["accessors"][numbers]["max"][0], static_cast<float>(scale_of(faces.study).most));
  EXPECT_EQ(json["accessors"][numbers]["count"], 12);
  const Scene back = formats::import_scene(folder / "hours.glb").value();
  EXPECT_TRUE(back.warnings.empty()) << back.warnings.front();
  const FrameGeometry frame = frame_of(back);
  ASSERT_EQ(frame.triangles.size(), faces.frame.triangles.size());
  for (int k = 0; k < 3; ++k)  // GLB has Y up
    EXPECT_EQ(back.frame.to_file(frame.positions[frame.triangles[0][k]]),
              faces.scene.frame.direction_to_scene(
                  faces.scene.frame.to_file(faces.frame.positions[faces.frame.triangles[0][k]])));
}

TEST(SunOutputs, TheGroundIsAMeshOfCells) {
  const GroundCase ground;
  const auto model = model_of(ground.study, scale_of(ground.study)).value();
  const Mesh& cells = model.scene.meshes.back();
  EXPECT_EQ(cells.name, "ground");
  ASSERT_EQ(cells.triangles.size(), 2 * ground.receivers.list.size());
  const glm::dvec3 first = ground.scene.frame.to_file(cells.positions[3]);  // the north-west corner
  EXPECT_EQ(first, far_off + glm::dvec3(-20, 20, 1));
  for (const glm::uvec3& t : cells.triangles)
    EXPECT_GT(
        glm::cross(cells.positions[t.y] - cells.positions[t.x], cells.positions[t.z] - cells.positions[t.x])
            .y,
        0);
  Receivers points;
  points.kind = ReceiverKind::points;
  EXPECT_FALSE(model_of({ground.scene, ground.frame, points, ground.suns, ground.hours}, {}).has_value());
}

TEST(SunOutputs, APlanShowsCellsAndTheirScale) {
  const GroundCase ground;
  const ColourScale scale = scale_of(ground.study);
  const io::Image8 plan = plan_of(ground.study, scale);
  ASSERT_EQ(plan.pixels.size(), std::size_t{3} * plan.width * plan.height);
  const auto pixel = [&](int x, int y) {
    const std::uint8_t* p = &plan.pixels[3 * (static_cast<std::size_t>(y) * plan.width + x)];
    return glm::ivec3(p[0], p[1], p[2]);
  };
  const glm::ivec3 first(glm::round(255.0f * scale(value_of(ground.study, 0)))),
      third_row(glm::round(255.0f * scale(value_of(ground.study, 9))));
  EXPECT_EQ(pixel(16, 16), first);
  EXPECT_EQ(pixel(16 + 32 + 1, 16 + 2 * 32 + 1), third_row);
  EXPECT_EQ(pixel(0, 0), glm::ivec3(255));
}

TEST(SunOutputs, AGeoTiffLiesWhereTheFileDoes) {
  const GroundCase ground;
  const std::string tiff = geotiff_of(ground.study, 25832);
  const auto at = [&]<class T>(std::size_t offset, T value) {
    std::memcpy(&value, tiff.data() + offset, sizeof value);
    return value;
  };
  const auto value_at = [&](int tag) {
    for (std::size_t i = 0; i < at(8, std::uint16_t{}); ++i)
      if (at(10 + 12 * i, std::uint16_t{}) == tag) return std::size_t{at(10 + 12 * i + 8, std::uint32_t{})};
    return std::size_t{0};
  };
  EXPECT_EQ(value_at(256), 4u);
  EXPECT_EQ(value_at(257), 4u);
  EXPECT_EQ(at(value_at(33550), 0.0), 10);
  EXPECT_EQ(at(value_at(33922) + 24, 0.0), far_off.x - 20);
  EXPECT_EQ(at(value_at(33922) + 32, 0.0), far_off.y + 20);
  EXPECT_EQ(at(value_at(34735) + 30, std::uint16_t{}), 25832);
  ASSERT_EQ(tiff.size(), value_at(273) + 4 * 16);
  EXPECT_EQ(at(value_at(273) + 4 * 9, 0.0f), static_cast<float>(value_of(ground.study, 9)));
}

}  // namespace
}  // namespace tenebra::sun
