// tenebra view under a virtual display, driven by real key and mouse events: time, lights, camera, the
// window.
#include <gtest/gtest.h>

#include "window_steps.h"

namespace tenebra::testing {
namespace {

using ViewWindow = WindowTest;

TEST_F(ViewWindow, PlaysScrubsStepsAndLoops) {
  const ViewSession session(display(), folder_, {write_moving_scene(folder_)});
  session.wait_for_picture();
  session.photograph("play_still");

  session.expect_state("playing", true, [&] { session.key("space"); });
  std::size_t from = session.count();
  const double begin_s = session.wait_for_event(from, "picture")["time_s"];
  session.wait_for(from, "time that goes on", [&](const Json& event) {
    return event["event"] == "picture" && event["time_s"] > begin_s + 0.3;
  });

  // Scrubbing while it plays: at most the one picture under way shows the old time.
  from = session.count();
  session.move_to("scrubber", 0.75);
  session.press();
  const Json asked = session.wait_for(from, "a request of the scrubbed time", [](const Json& event) {
    return event["event"] == "request" && std::abs(event["time_s"].get<double>() - 7.5) < 0.3;
  });
  session.wait_for(from, "its picture", [&](const Json& event) {
    return event["event"] == "picture" && event["request"] >= asked["number"];
  });
  session.release();
  int late = 0;
  bool after = false;
  for (const Json& event : session.events()) {
    after = after || event == asked;
    if (!after || event["event"] != "picture") continue;
    if (event["request"] >= asked["number"]) {
      EXPECT_EQ(event["time_s"], asked["time_s"]) << "time stands while the scrubber is held";
      break;
    }
    ++late;
  }
  EXPECT_LE(late, 1) << "pictures of the old time after the hand had moved on";
  EXPECT_EQ(session.state()["playing"], true) << "scrubbing does not stop it";
  session.photograph("play_scrubbed");

  session.expect_state("playing", false, [&] { session.key("space"); });
  const int frame = session.wait_for_picture()["frame"];
  session.key("Right");
  const Json next = session.wait_for_picture();
  EXPECT_EQ(next["frame"], (frame + 1) % moving_scene_frames);
  EXPECT_EQ(next["time_s"].get<double>(), next["frame"].get<int>() / 30.0) << "a whole frame";
  session.key("Left");
  session.key("Left");
  EXPECT_EQ(session.wait_for_picture()["frame"], (frame + moving_scene_frames - 1) % moving_scene_frames);
  session.expect_state("loop", false, [&] { session.click("loop"); });
  session.key("End");
  EXPECT_EQ(session.wait_for_picture()["time_s"], 10.0);
  session.expect_state("speed", -4.0,
                       [&] { session.move_to("speed", 0.01), session.press(), session.release(); });
  from = session.count();
  session.expect_state("playing", true, [&] { session.key("space"); });
  session.wait_for(from + 1, "the stop at the begin",
                   [](const Json& event) { return event["event"] == "state" && event["playing"] == false; });
  EXPECT_EQ(session.wait_for_picture()["time_s"], 0.0);
  quit(session);
}

TEST_F(ViewWindow, MovesLightsAndCamera) {
  const ViewSession session(display(), folder_,
                            {write_moving_scene(folder_, 2), "--eye", "0,3,9", "--look-at", "0,1,0"});
  session.wait_for_picture();
  const std::string start = session.state()["free"];

  const auto before = session.place("light.1");
  std::size_t from = session.count();
  session.drag("light.1", -90, 20);
  const Json moved = session.wait_for(from, "a moved light", [](const Json& event) {
    return event["event"] == "state" && !event["lights"].empty();
  });
  EXPECT_TRUE(moved["lights"][0].get<std::string>().starts_with("1 move=-")) << moved.dump();
  session.wait_for_picture();
  const auto now = session.place("light.1");
  EXPECT_NEAR(now[0], before[0] - 90, 3) << "the circle is under the hand";
  EXPECT_NEAR(now[1], before[1] + 20, 3);
  EXPECT_EQ(session.state()["free"], start) << "the camera stood still";
  session.click("section.Lights");
  session.photograph("lights");
  const std::size_t rays = session.wait_for_picture()["rays"];
  session.click("light.1.on");
  EXPECT_LT(session.wait_for_picture()["rays"].get<std::size_t>(), rays)
      << "a light that is off gets no rays";
  EXPECT_NE(session.state()["lights"].dump().find("on=0"), std::string::npos);

  const auto view = session.place("view");
  session.drag(view[2] / 2, view[3] / 2 + 100, 60, 20);
  const std::string orbited = session.state()["free"];
  EXPECT_NE(orbited, start);
  from = session.count();
  session.xdotool({"mousemove", std::to_string(int(view[2] / 2)), std::to_string(int(view[3] * 0.7)), "click",
                   "--repeat", "2", "--delay", "60", "1"});
  session.wait_for(from, "a camera that looks at the clicked point",
                   [&](const Json& event) { return event["event"] == "state" && event["free"] != orbited; });
  from = session.count();
  session.xdotool({"keydown", "w"});
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  session.xdotool({"keyup", "w"});
  session.wait_for(from, "a flight",
                   [&](const Json& event) { return event["event"] == "state" && event["camera"] == "fly"; });
  session.wait_for_picture();
  session.photograph("flown");
  session.expect_state("free", start, [&] { session.key("BackSpace"); });
  quit(session);
}

TEST_F(ViewWindow, TakesAClickWhereItWasMade) {
  const ViewSession session(display(), folder_, {write_moving_scene(folder_)});
  session.wait_for_picture();
  const auto [left, top, right, bottom] = session.place("loop");
  const std::string x = std::to_string(int(left) + 8), y = std::to_string(int(top + bottom) / 2);
  for (const bool loop : {false, true, false}) {  // the hand is away again before the window has drawn
    session.expect_state("loop", loop, [&] {
      session.xdotool({"mousemove", x, y, "mousedown", "1", "mouseup", "1", "mousemove", "40", "40"});
    });
  }
  quit(session);
}

TEST_F(ViewWindow, ResizesAndExplainsItself) {
  const ViewSession session(display(), folder_, {write_moving_scene(folder_)});
  const Json large = session.wait_for_picture();
  session.expect_state("help", true, [&] { session.key("question"); });
  session.photograph("help");
  session.expect_state("help", false, [&] { session.key("Escape"); });
  const std::size_t from = session.count();
  const auto resize = [&](const char* width, const char* height) {
    const std::string window = display().run({"xdotool", "search", "--name", "Tenebra"}).output;
    session.xdotool({"windowsize", window.substr(0, window.find('\n')), width, height});
  };
  resize("420", "300");
  const Json small = session.wait_for(from, "a smaller picture", [&](const Json& event) {
    return event["event"] == "picture" && event["width"] == 420;
  });
  EXPECT_LT(small["height"], 300);
  session.photograph("small");
  resize("1180", "700");
  session.wait_for(from, "a larger picture", [&](const Json& event) {
    return event["event"] == "picture" && event["width"].get<int>() > 700;
  });
  session.expect_state("panel", false, [&] { session.key("Tab"); });
  EXPECT_EQ(session.wait_for_picture()["width"], 1180);
  quit(session);
}

TEST_F(ViewWindow, ScalesWithTheDisplay) {
  const VirtualDisplay dense("2560x1500x24", 192);
  const ViewSession session(dense, folder_, {write_moving_scene(folder_)});
  session.wait_for_picture();
  const auto play = session.place("play");
  EXPECT_NEAR(play[3] - play[1], 2 * 23, 4) << "buttons are twice as large at 192 dots an inch";
  session.photograph("hidpi");
  quit(session);
}

}  // namespace
}  // namespace tenebra::testing
