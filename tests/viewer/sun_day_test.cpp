// The window's sun of a day: its suns, hours for the pixels of a picture, the light that follows, and a
// pixel's day.
#include <gtest/gtest.h>

#include "session/session.h"
#include "window/frames/sun_counter.h"
#include "window_steps.h"

namespace tenebra::viewer {
namespace {

SunDay equinox() {
  SunDay day;
  day.place = {48, 0}, day.day = sun::parse_day("2026-03-20").value();
  return day;
}

TEST(SunDay, StandsWhereTheClockSays) {
  SunDay day = equinox();
  EXPECT_NEAR(sun_at(day).azimuth_deg, 180, 4);
  EXPECT_NEAR(sun_at(day).altitude_deg, 42, 0.5);
  EXPECT_GT(way_to_sun(day).z, 0.7) << "-Z is north";
  SunDay ahead = day;
  ahead.zone_min = 120, ahead.minute += 120;
  EXPECT_EQ(way_to_sun(ahead), way_to_sun(day));
  EXPECT_FALSE(same_suns(ahead, day));
  day.minute = 0;
  EXPECT_TRUE(same_suns(day, equinox()));
  double minutes = 0;
  for (const sun::Sun& sun : suns_of_day(day).list) minutes += sun.weight;
  EXPECT_NEAR(minutes, 720, 10);
}

TEST(SunDay, DaysOfTheYear) {
  const auto day = [](const char* text) { return sun::parse_day(text).value(); };
  EXPECT_EQ(day_of_year(day("2026-01-01")), 1);
  EXPECT_EQ(day_of_year(day("2024-12-31")), 366);
  EXPECT_EQ(with_day_of_year(day("2024-07-01"), 366), day("2024-12-31"));
  EXPECT_EQ(with_day_of_year(day("2026-07-01"), 366), day("2026-12-31"));
}

/// A picture of a floor with a wall of 2 m from west to east, from straight above; north is up, a metre is
/// two pixels.
std::shared_ptr<const Picture> picture_of_a_wall(const testing::TemporaryFolder& folder) {
  testing::write_text(
      folder / "wall.obj",
      "v -20 0 20\nv 20 0 20\nv 20 0 -20\nv -20 0 -20\nv -20 0 0\nv 20 0 0\nv 20 2 0\nv -20 2 0\n"
      "f 1 2 3 4\nf 5 6 7 8\n");
  SceneOptions options;
  options.file = (folder / "wall.obj").string();
  options.import.placement.up = UpAxis::y;
  auto session = session::Session::open(options, {.kind = render::RasterKind::cpu}).value();
  auto picture = std::make_shared<Picture>();
  picture->scene = std::make_shared<session::StagedScene>(session.staged());
  const Size size{64, 64};
  const session::Viewpoint above{.placed = session::PlacedCamera{{0, 38.63f, 0}, {0, 0, 0}, {0, 0, -1}, 45}};
  picture->view = session::rays_of(session.staged(), above, 0, size);
  session.place(0, picture->view);
  render::RenderSettings settings;
  settings.width = size.width, settings.height = size.height;
  EXPECT_TRUE(session.draw(settings, picture->a.result));
  const auto ids = session.renderer().triangle_ids();
  picture->evidence.ids.assign(ids.begin(), ids.end());
  return picture;
}

// At the equinox the shadow of the wall ends 2 m * tan(48 degrees) = 2.2 m north of it, all day.
TEST(SunCounter, CountsTheHoursOfPixels) {
  const testing::TemporaryFolder folder;
  const auto picture = picture_of_a_wall(folder);
  const SunDay day = equinox();
  const SunQuestion question{picture, day, std::make_shared<sun::Suns>(suns_of_day(day))};
  const StopFlag stop;
  double part = 0;
  const CountedSun counted = count_sun(
                                 question, [&](double done) { part = done; }, stop)
                                 .value();
  EXPECT_EQ(part, 1);
  EXPECT_NEAR(counted.most_h, 12, 0.2);
  EXPECT_LT(counted.least_h, 1.5);
  const auto pixel = [&](int x, int y) {
    const std::uint8_t* const p = &counted.image.pixels[std::size_t{4} * (64 * y + x)];
    return std::array<int, 4>{p[0], p[1], p[2], p[3]};
  };
  const std::array<int, 4> all_day{253, 231, 37, 255};
  EXPECT_EQ(pixel(32, 40), all_day) << "4 m south of the wall";
  EXPECT_EQ(pixel(32, 22), all_day) << "5 m north of it";
  EXPECT_LT(pixel(32, 30)[1], 80) << "1 m north of it: viridis is dark";
  EXPECT_TRUE(same_hours(*picture, *picture));
  StopFlag stopped;
  stopped.request();
  EXPECT_TRUE(is_stop(count_sun(
      question, [](double) {}, stopped)));
}

}  // namespace
}  // namespace tenebra::viewer

namespace tenebra::testing {
namespace {

using ViewSun = WindowTest;

void type_day(const ViewSession& session, const char* day) {
  session.click("sun.day");  // selects all
  session.xdotool({"type", "--delay", "20", day});
  session.key("Return");
}

TEST_F(ViewSun, TurnsTheSunCountsHoursAndSaysWhoIsInTheWay) {
  const std::string scene = write_moving_scene(folder_);
  const ViewSession session(display(), folder_,
                            {scene, "--eye", "0,8,0.001", "--look-at", "0,0,0", "--up", "0,0,-1", "--fov",
                             "60", "--size", "400x400"});
  session.wait_for_picture();
  session.click("section.Sun of a day");
  session.place("sun.day");
  type_day(session, "2026-06-21");
  session.wait_until("a sun", [&] {
    return session.state()["edits"].dump().find("--add-light directional") != std::string::npos;
  });
  EXPECT_EQ(session.state()["sun"], "2026-06-21 12:00");
  session.wait_for_picture();
  const Json turned = session.state()["edits"];
  std::size_t from = session.count();
  session.click("sun.colours");
  session.wait_for(from, "the hours", [](const Json& event) {
    return event["event"] == "sun" && event["text"].get<std::string>().starts_with("over");
  });
  session.place("sun.legend");
  session.photograph("sun_hours");

  const auto place = session.place("picture");
  from = session.count();
  session.move_to(place[0] + 83, place[1] + 207);  // west of the blocker: in its shadow in the morning
  session.press();
  session.release();
  const Json answer = session.wait_for(from, "the day of a pixel", [](const Json& event) {
    return event["event"] == "explained" && event.contains("day");
  });
  EXPECT_NE(answer["day"].dump().find("lit"), std::string::npos);
  EXPECT_NE(answer["day"].dump().find("node 1"), std::string::npos) << answer["day"];
  session.place("why.day.blocker.0");
  session.photograph("sun_day");
  session.click("sun.minute");
  session.wait_until("another place of the sun", [&] { return session.state()["edits"] != turned; });
  session.expect_state("edits", turned, [&] { session.key("ctrl+z"); });
  quit(session);
}

}  // namespace
}  // namespace tenebra::testing
