// Casters of a part of the year, see-through casters, and those that cast nothing.
#include <gtest/gtest.h>

#include <fstream>

#include <tenebra/threads.h>
#include "sun/seasons.h"
#include "sun_scenes.h"
#include "weather_files.h"

namespace tenebra::sun {
namespace {

using testing::frame_of;

/// A floor and two sheets high above it, one over the other: "leaves", and "roof" of a material that is
/// see-through where `tint` is below 1. Z is up.
Scene sheets(bool roof, float tint = 1) {
  const testing::TemporaryFolder folder;
  std::ofstream mtl(folder / "map.mtl");
  mtl << "newmtl solid\nKd 1 1 1\nnewmtl pane\nKd " << tint << ' ' << tint << ' ' << tint << "\nd 0.5\n";
  mtl.close();
  std::ofstream obj(folder / "map.obj");
  obj << "mtllib map.mtl\no floor\nusemtl solid\n"
         "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"
         "o leaves\nv -900 -900 5\nv 900 -900 5\nv 900 900 5\nv -900 900 5\nf 5 6 7 8\n";
  if (roof)
    obj << "o roof\nusemtl pane\nv -900 -900 7\nv 900 -900 7\nv 900 900 7\nv -900 900 7\nf 9 10 11 12\n";
  obj.close();
  formats::ImportOptions options;
  options.placement.up = UpAxis::z;
  return formats::import_scene(folder / "map.obj", options).value();
}

Receivers floor_of(const Scene& scene, const FrameGeometry& frame) {
  return face_receivers(scene, frame, {.nodes = {"floor"}, .per_face = 1}).value();
}

/// Noons of every month, each of an hour and of 1,000 Wh/m2 from above.
Suns noons() {
  Suns suns;
  suns.kind = SunKind::radiation;
  for (int month = 0; month < 12; ++month) {
    const Day day = parse_day("2026-" + fmt::format("{:02}", month + 1) + "-15").value();
    suns.list.push_back(
        {{0, 1, 0}, 60, 86400.0 * static_cast<double>(day.time_since_epoch().count()) + 43200, month, 1000});
    suns.diffuse_wh_m2[day_of_year(suns.list.back().utc_s, 0)] = 100;
  }
  return suns;
}

TEST(Seasons, LeavesCastInTheirMonths) {
  const Scene scene = sheets(false);
  const FrameGeometry frame = frame_of(scene);
  const Receivers floor = floor_of(scene, frame);
  const Suns suns = noons();
  const auto hours = [&](std::vector<SeasonalCaster> leaves) {
    return hours_of({scene, frame, std::move(leaves)}, floor, suns, {.months = true}).value();
  };
  EXPECT_EQ(hours({}).sums[0], 0);
  const SunHours summer = hours({parse_seasonal("leaves=4:10").value()});
  EXPECT_EQ(summer.sums[0], 5 * 60);
  EXPECT_EQ(summer.light[0], 5000);
  EXPECT_EQ(summer.months[2], 1000);
  EXPECT_EQ(summer.months[3], 0);
  EXPECT_EQ(summer.months[10], 1000);
  EXPECT_EQ(summer.first[0], 0);
  EXPECT_EQ(summer.last[0], 11);
  const SunHours winter = hours({parse_seasonal("leaves=11-16:02-15").value()});
  EXPECT_EQ(winter.sums[0], 9 * 60) << "around the end of the year, the last day too";
  EXPECT_EQ(winter.first[0], 2);
  EXPECT_EQ(winter.last[0], 10);
  EXPECT_EQ(hours({parse_seasonal("leaves=1:6").value(), parse_seasonal("leaves=4:12").value()}).sums[0], 540)
      << "a node that is named twice casts while both hold";
  const SkyLight sky = sky_of({scene, frame, {parse_seasonal("leaves=4:10").value()}}, floor, suns,
                              {{{0, 1, 0}, 0, 0, 0, 1}}, {})
                           .value();
  EXPECT_EQ(sky.light[0], 500);
}

TEST(Seasons, RefusesInASentence) {
  const Scene scene = sheets(false);
  const FrameGeometry frame = frame_of(scene);
  EXPECT_NE(
      hours_of({scene, frame, {parse_seasonal("tree=1:2").value()}}, floor_of(scene, frame), noons(), {})
          .error()
          .message.find("no node called tree"),
      std::string::npos);
  for (const char* text : {"", "leaves", "=4:10", "leaves=", "leaves=13:1"})
    EXPECT_FALSE(parse_seasonal(text)) << text;
}

// Both sides of a pane's sheet are one surface: its transmittance once, as TintTracer has it.
TEST(Glass, DimsByItsTint) {
  const Suns suns = noons();
  for (const float tint : {1.0f, 0.25f}) {
    Scene scene = sheets(true, tint);
    scene.nodes[1].visible = false;
    const FrameGeometry frame = frame_of(scene);
    const Receivers floor = floor_of(scene, frame);
    const double whole = 12 * 60;
    const double seen = hours_of({scene, frame, {}}, floor, suns, {}).value().sums[0] / whole;
    TintTracer tracer;
    VisiblePoints point{.width = 1, .height = 1};
    point.positions = {floor.positions[0]}, point.triangles = {floor.triangles[0]}, point.sides = {1};
    TintMask expected;
    const SurfaceCoordinates coordinates = surface_coordinates(scene);
    tracer.trace(point, triangle_view(frame), see_through_surfaces(scene, frame, coordinates),
                 {.directional = true, .to_light = {0, 1, 0}}, {255}, {}, expected);
    ASSERT_EQ(expected.factors.size(), 1u);
    EXPECT_NEAR(seen, expected.factors[0].g, 1e-6);
    EXPECT_GT(seen, 0.1);
    EXPECT_LT(seen, 0.9);
    const double disc = hours_of({scene, frame, {}}, floor, suns, {.disc_deg = 0.5}).value().sums[0] / whole;
    EXPECT_NEAR(disc, seen, 1e-6);
    EXPECT_EQ(
        hours_of({scene, frame, {parse_seasonal("roof=2:1").value()}}, floor, suns, {}).value().sums[0] /
            whole,
        seen);
    EXPECT_EQ(hours_of({scene, frame, {parse_seasonal("roof=3:3").value()}}, floor, suns, {.months = true})
                  .value()
                  .months[0],
              1000)
        << "out of its season a pane lets all through";
  }
}

TEST(Glass, IsTheSameWithAnyNumberOfPointsAndThreads) {
  Scene scene = sheets(true, 0.5f);
  scene.nodes[1].visible = false;
  const FrameGeometry frame = frame_of(scene);
  const Receivers cells = ground_receivers(frame, scene.frame, 1, 20).value();
  const Suns suns = testing::day_of_suns(48, "2026-06-21", 240);
  std::vector<SunHours> hours;
  for (const int threads : {1, 3})
    with_threads(threads, [&] { hours.push_back(hours_of({scene, frame, {}}, cells, suns, {}).value()); });
  EXPECT_EQ(hours[0].sums, hours[1].sums);
  const std::size_t middle = cells.list.size() / 2 + static_cast<std::size_t>(cells.grid.columns) / 2;
  EXPECT_EQ(hours[0].sums[middle], hours[0].sums[middle + 1]);
  EXPECT_GT(hours[0].sums[middle], 0);
}

/// Cells [first, end) alone.
Receivers cells_of(const Receivers& all, std::size_t first, std::size_t end) {
  Receivers out;
  out.kind = all.kind;
  for (std::size_t i = first; i < end; ++i) {
    out.positions.push_back(all.positions[i]), out.normals.push_back(all.normals[i]);
    out.list.push_back(all.list[i]);
    out.list.back().end = static_cast<std::uint32_t>(out.list.size());
  }
  return out;
}

// More cells than are asked at a time: each is as when it is asked in a short list.
TEST(Glass, IsTheSameInLongLists) {
  Scene scene = sheets(true, 0.5f);
  scene.nodes[1].visible = false;
  const FrameGeometry frame = frame_of(scene);
  const Receivers cells = ground_receivers(frame, scene.frame, 1, 3.5).value();
  constexpr std::size_t at_a_time = std::size_t{1} << 18;
  ASSERT_GT(cells.list.size(), at_a_time + 3);
  Suns suns = noons();
  suns.list.resize(1);
  suns.list[0].to_sun = glm::normalize(glm::dvec3(-1, 1, 0));  // in the west: past the sheet from its edge
  const auto hours = [&](const Receivers& of, int threads) {
    SunHours out;
    with_threads(threads, [&] { out = hours_of({scene, frame, {}}, of, suns, {}).value(); });
    return out;
  };
  const SunHours one = hours(cells, 1), three = hours(cells, 3);
  EXPECT_EQ(one.sums, three.sums);
  EXPECT_EQ(one.light, three.light);
  const std::size_t count = cells.list.size(), row = static_cast<std::size_t>(cells.grid.columns);
  for (const auto& [first, end] : {std::pair(row, row + 3), std::pair(at_a_time - 3, at_a_time + 3),
                                   std::pair(count - row - 4, count - row)}) {
    const SunHours few = hours(cells_of(cells, first, end), 1);
    for (std::size_t i = first; i < end; ++i) {
      EXPECT_EQ(one.sums[i], few.sums[i - first]) << i;
      EXPECT_EQ(one.light[i], few.light[i - first]) << i;
      EXPECT_EQ(one.last[i], few.last[i - first]) << i;
    }
  }
  EXPECT_GT(one.light[row + 1], one.light[count - row - 2]);
  EXPECT_GT(one.light[count - row - 2], 0);
}

}  // namespace
}  // namespace tenebra::sun
