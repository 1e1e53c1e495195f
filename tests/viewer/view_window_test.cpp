// tenebra view under a virtual display, driven by real key and mouse events.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "base/image.h"
#include "window_driver.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;

base::Image8 picture_of(const fs::path& file) {
  auto image = base::read_png(file);
  EXPECT_TRUE(image) << image.error().message;
  return image ? std::move(*image) : base::Image8{};
}

/// Waits for the file of a screenshot.
fs::path shot_after(const ViewSession& session, const std::string& keys) {
  const std::size_t from = session.count();
  session.key(keys);
  return session.wait_for_event(from, "shot").value("text", "");
}

/// The part of a picture of the window that shows the scene.
base::Image8 cut(const base::Image8& window, const std::array<double, 4>& place) {
  const auto [left, top, right, bottom] = place;
  base::Image8 out{static_cast<int>(right - left), static_cast<int>(bottom - top), window.channels, {}};
  for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y) {
    const auto row =
        window.pixels.begin() + (static_cast<std::ptrdiff_t>(y) * window.width + static_cast<int>(left)) * 3;
    out.pixels.insert(out.pixels.end(), row, row + static_cast<std::ptrdiff_t>(out.width) * 3);
  }
  return out;
}

base::Image8 rendered(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "render");
  arguments.insert(arguments.end(), {"-o", folder / "rendered.png", "--quiet"});
  const auto result = tenebra(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return picture_of(folder / "rendered.png");
}

void quit(const ViewSession& session) {
  session.key("ctrl+q");
  const auto result = session.wait();
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  session.expect_no_gl_errors();
}

TEST(ViewWindow, PlaysScrubsStepsAndLoops) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const VirtualDisplay display;
  const ViewSession session(display, folder, {write_moving_scene(folder)});
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

TEST(ViewWindow, FlipsEveryMethod) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const VirtualDisplay display;
  const ViewSession session(display, folder,
                            {write_moving_scene(folder), "--ao-cache", "none", "--light-size", "1x1",
                             "--shots", folder / "shot_%d.png"});
  const Json hard = session.wait_for_picture();
  EXPECT_GT(hard["rays"], 0);

  const auto shows = [&](const char* widget, const char* option) {
    const std::size_t from = session.count();
    session.click(widget);
    session.wait_for(from, option, [&](const Json& event) {
      return event["event"] == "state" && event["a"].get<std::string>().find(option) != std::string::npos;
    });
    return session.wait_for_picture();
  };
  session.click("section.Research");
  EXPECT_EQ(shows("shadows.none", "--shadows none")["rays"], 0);
  const Json soft = shows("shadows.soft", "--shadows soft");
  EXPECT_EQ(soft["rays"], 0);
  EXPECT_GT(soft["soft_groups"], 0);
  session.photograph("method_soft");
  shows("solver.bsp", "--soft-solver bsp");
  shows("solver.clip", "--soft-solver clip");
  shows("grouping.triangle", "--soft-grouping triangle");
  shows("precision.reference", "--soft-precision reference");
  EXPECT_GT(shows("ao.rays", "--ao rays")["ao_points"], 0);
  EXPECT_GT(shows("ao.field", "--ao field")["ao_points"], 0);
  session.photograph("method_ao");
  const Json fast = shows("quality.fast", "--soft-points 8 --ao field --ao-rays 16 --ao-downscale 2");
  EXPECT_GT(fast["rays"], 0) << "eight hard shadows";
  EXPECT_EQ(fast["soft_groups"], 0) << "and no exact solver";
  EXPECT_GT(shows("quality.exact", "--ao field --ao-rays 256")["soft_groups"], 0);
  session.click("quality.balanced");
  session.wait_for_picture();
  session.click("ao.none");
  session.click("shadows.hard");
  session.wait_for_picture();
  shows("samples.depth", "--samples depth");
  session.click("samples.ids");
  session.wait_for_picture();

  const fs::path before = shot_after(session, "p");
  std::vector<std::string> variants;
  for (int i = 0; i < 7; ++i) {
    const std::size_t from = session.count();
    session.key("v");
    const Json state = session.wait_for_event(from, "state");
    variants.push_back(state["a"]);
    session.wait_for_picture();
    EXPECT_EQ(picture_of(shot_after(session, "p")), picture_of(before)) << "the same mask by " << state["a"];
  }
  std::sort(variants.begin(), variants.end());
  EXPECT_EQ(std::unique(variants.begin(), variants.end()) - variants.begin(), 7) << "seven variants in turn";

  session.expect_state("overlay", "nodes", [&] { session.key("n"); });
  EXPECT_GT(session.wait_for_picture()["overlay_peak"], 0);
  session.photograph("method_heat");
  session.key("3");
  session.expect_state("overlay", "classes", [&] { session.key("m"); });
  std::size_t classified = 0;
  const Json last = session.wait_for_picture();
  for (const std::size_t size : last["overlay_classes"]) classified += size;
  EXPECT_EQ(classified, last["width"].get<std::size_t>() * last["height"].get<std::size_t>());
  session.photograph("method_classes");
  quit(session);
}

TEST(ViewWindow, MovesLightsAndCamera) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const VirtualDisplay display;
  const ViewSession session(display, folder,
                            {write_moving_scene(folder, 2), "--eye", "0,3,9", "--look-at", "0,1,0"});
  session.wait_for_picture();
  const std::string start = session.state()["free"];

  const auto [left, top, right, bottom] = session.place("light.1");
  std::size_t from = session.count();
  session.move_to((left + right) / 2, (top + bottom) / 2);
  session.press();
  session.move_to((left + right) / 2 - 90, (top + bottom) / 2 + 20);
  session.release();
  const Json moved = session.wait_for(from, "a moved light", [](const Json& event) {
    return event["event"] == "state" && !event["lights"].empty();
  });
  EXPECT_TRUE(moved["lights"][0].get<std::string>().starts_with("1 move=-")) << moved.dump();
  session.wait_for_picture();
  const auto now = session.place("light.1");
  EXPECT_NEAR(now[0], left - 90, 3) << "the circle is under the hand";
  EXPECT_NEAR(now[1], top + 20, 3);
  EXPECT_EQ(session.state()["free"], start) << "the camera stood still";
  session.click("section.Lights");
  session.photograph("lights");
  const std::size_t rays = session.wait_for_picture()["rays"];
  session.click("light.1.on");
  EXPECT_LT(session.wait_for_picture()["rays"].get<std::size_t>(), rays)
      << "a light that is off gets no rays";
  EXPECT_NE(session.state()["lights"].dump().find("on=0"), std::string::npos);

  const auto view = session.place("view");
  session.move_to(view[2] / 2, view[3] / 2 + 100);
  session.press();
  session.move_to(view[2] / 2 + 60, view[3] / 2 + 120);
  session.release();
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

TEST(ViewWindow, TakesAClickWhereItWasMade) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const VirtualDisplay display;
  const ViewSession session(display, folder, {write_moving_scene(folder)});
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

TEST(ViewWindow, CopiesWhatItShowsForRender) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const VirtualDisplay display;
  const ViewSession session(display, folder,
                            {scene, "--shots", folder / "shot_%d.png", "--light-size", "0.5", "--eye",
                             "0,3,9", "--look-at", "0,1,0"});
  session.wait_for_picture();
  session.key("3");
  session.click("section.Lights");
  session.move_to("light.0.size", 0.25);
  session.press();
  session.move_to(session.place("light.0.size")[0] + 120, session.place("light.0.size")[1] + 8);
  session.release();
  const auto light = session.place("light.0");
  session.move_to((light[0] + light[2]) / 2, (light[1] + light[3]) / 2);
  session.press();
  session.move_to((light[0] + light[2]) / 2 + 40, (light[1] + light[3]) / 2);
  session.release();
  EXPECT_NE(session.state()["lights"].dump().find("size="), std::string::npos) << session.state()["lights"];
  const std::string start = session.state()["free"];
  session.move_to(300, 300);
  session.press();
  session.move_to(371, 283);
  session.release();
  EXPECT_NE(session.state()["free"], start);
  session.wait_for_picture();
  const std::size_t from = session.count();
  session.key("ctrl+c");
  const std::string copied = session.wait_for_event(from, "copied").value("text", "");
  for (const char* option : {"--eye", "--time", "--size", "--shadows soft", "--set-light '0 move="}) {
    EXPECT_NE(copied.find(option), std::string::npos) << copied;
  }
  const std::string command = fmt::format("exec '{}' render '{}' {} -o '{}' --quiet", TENEBRA_PROGRAM, scene,
                                          copied, (folder / "pasted.png").string());
  const auto pasted = run_program({"/bin/sh", "-c", command});
  EXPECT_EQ(pasted.errors, "");
  EXPECT_EQ(picture_of(shot_after(session, "p")), picture_of(folder / "pasted.png"));
  quit(session);
}

TEST(ViewWindow, ShowsTheBitsOfRender) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder, 2);
  const VirtualDisplay display;
  const std::vector<std::vector<std::string>> methods{
      {"--shadows", "none"},
      {"--shadows", "hard"},
      {"--shadows", "hard", "--variant", "Spheres", "--exposure", "2"},
      {"--shadows", "soft", "--light-size", "1x0.5"},
      {"--shadows", "soft", "--set-light", "1 size=1x0.5 move=0,0.5,0.25 intensity=2", "--set-light",
       "0 on=0"},
      {"--shadows", "hard", "--ao", "rays", "--ao-rays", "16", "--eye", "3,4,5", "--look-at", "0,0,0"},
      {"--shadows", "none", "--ao", "field", "--ao-positions", "100", "--ao-directions", "64", "--ao-cache",
       "none"}};
  for (const auto& method : methods) {
    std::vector<std::string> arguments{scene, "--time", "2.125", "--size", "400x300"};
    arguments.insert(arguments.end(), method.begin(), method.end());
    const base::Image8 expected = rendered(folder, arguments);
    arguments.insert(arguments.end(), {"--shots", folder / "shot_%d.png"});
    const ViewSession session(display, folder, arguments);
    session.wait_for_picture();
    // The lights' circles lie over the picture: they go for the comparison, and messages by themselves.
    session.click("section.Lights");
    session.click("circles");
    session.move_to("scrubber");
    session.wait_for_picture();
    session.wait_until_gone("message");
    const base::Image8 window = picture_of(shot_after(session, "shift+p"));
    EXPECT_EQ(cut(window, session.place("picture")), expected) << "pixels of the window, " << method[1];
    EXPECT_EQ(picture_of(shot_after(session, "p")), expected) << method[1];
    quit(session);
  }
}

TEST(ViewWindow, ShowsMarkedPreviewsWhileAKeyIsHeldAndRefinesThem) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const std::string scene = TENEBRA_SCENES_DIR "/court.glb";
  const VirtualDisplay display;
  const ViewSession session(
      display, folder, {scene, "--shadows", "soft", "--size", "640x480", "--shots", folder / "shot_%d.png"});
  const Json first = session.wait_for_picture();  // takes seconds
  std::size_t from = session.count();
  session.xdotool({"keydown", "w"});
  session.wait_for(from, "a preview", [&](const Json& event) {
    return event["event"] == "picture" && event["request"] > first["request"] && event["preview"] != "";
  });
  session.wait_for(from, "its mark in the window",
                   [](const Json& event) { return event["event"] == "marks" && event.contains("preview"); });
  session.photograph("preview");
  session.xdotool({"keyup", "w"});
  const base::Image8 saved = picture_of(shot_after(session, "p"));  // waits for the whole picture
  session.wait_for_picture();
  session.wait_until_gone("preview");
  from = session.count();
  session.key("ctrl+c");
  const std::string copied = session.wait_for_event(from, "copied").value("text", "");
  const std::string command = fmt::format("exec '{}' render '{}' {} -o '{}' --quiet", TENEBRA_PROGRAM, scene,
                                          copied, (folder / "pasted.png").string());
  EXPECT_EQ(run_program({"/bin/sh", "-c", command}).errors, "");
  EXPECT_EQ(saved, picture_of(folder / "pasted.png")) << "refined to the bits of render";
  quit(session);
}

TEST(ViewWindow, ComparesTwoMethods) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const VirtualDisplay display;
  const ViewSession session(display, folder,
                            {write_moving_scene(folder), "--compare=--shadows none", "--show", "difference"});
  const Json shadowed = session.wait_for_picture();
  EXPECT_GT(shadowed["differing"], 100);
  EXPECT_GT(shadowed["largest"], 10);
  EXPECT_EQ(shadowed["nodes_b"], 0);
  session.photograph("compare_difference");
  session.expect_state("show", "wipe", [&] { session.click("show.wipe"); });
  session.wait_for_picture();
  session.photograph("compare_wipe");
  const auto wipe = session.place("wipe");
  std::size_t from = session.count();
  session.move_to((wipe[0] + wipe[2]) / 2, (wipe[1] + wipe[3]) / 3);
  session.press();
  session.move_to((wipe[0] + wipe[2]) / 2 + 120, (wipe[1] + wipe[3]) / 3);
  session.release();
  session.wait_for(from, "the wipe",
                   [](const Json& event) { return event["event"] == "state" && event["wipe"] > 0.55; });
  session.expect_state("show", "side", [&] { session.click("show.side"); });
  const Json side = session.wait_for_picture();
  EXPECT_NEAR(side["width"].get<double>(), shadowed["width"].get<double>() / 2, 4);
  session.photograph("compare_side");
  session.expect_state("show", "b", [&] { session.key("x"); });
  session.expect_state("show", "a", [&] { session.key("x"); });
  session.expect_state("compare", false, [&] { session.key("b"); });
  // The same method in both slots: not a pixel differs.
  session.expect_state("compare", true, [&] { session.key("b"); });
  session.expect_state("show", "b", [&] { session.key("x"); });
  session.key("2");
  EXPECT_EQ(session.wait_for_picture()["differing"], 0);
  quit(session);
}

TEST(ViewWindow, LogsRecordsAndLeaves) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const VirtualDisplay display;
  const ViewSession session(display, folder,
                            {scene, "--size", "160x120", "--shadows", "soft", "--light-size", "1x1",
                             "--quality", "fast", "--record", folder / "out/%04d.png", "--exit-after", "4"});
  EXPECT_EQ(session.wait().exit_code, 0);
  const auto render =
      tenebra({"render", scene, "--size", "160x120", "--shadows", "soft", "--light-size", "1x1",
               "--soft-points", "8", "--frames", "0:3", "-o", folder / "render/%04d.png"});
  ASSERT_EQ(render.exit_code, 0) << render.errors;
  for (const char* name : {"0000.png", "0001.png", "0002.png", "0003.png"}) {
    EXPECT_EQ(picture_of(folder / "out" / name), picture_of(folder / "render" / name)) << name;
  }

  const ViewSession logging(display, folder, {scene, "--size", "160x120", "--log", folder / "frames.csv"});
  logging.wait_for_picture();
  for (const int frame : {1, 2}) {
    logging.key("Right");
    logging.wait_for(0, "the next frame", [&](const Json& event) {
      return event["event"] == "picture" && event["frame"] == frame && event["preview"] == "";
    });
  }
  logging.click("section.Picture");  // makes room
  logging.click("section.Research");
  logging.click("log");
  logging.wait_for(0, "the log", [&](const Json& event) {
    return event["event"] == "message" && event["text"].get<std::string>().starts_with("Log written");
  });
  quit(logging);
  const std::string log = read_text(folder / "frames.csv");
  const std::string render_log = [&] {
    tenebra({"render", scene, "--size", "160x120", "-o", "none", "--log", folder / "render.csv"});
    return read_text(folder / "render.csv");
  }();
  const auto header = [](const std::string& text) {
    const std::size_t at = text.find("\nframe,");
    return text.substr(at + 1, text.find('\n', at + 1) - at - 1);
  };
  EXPECT_EQ(header(log), header(render_log)) << "the same columns";
  EXPECT_NE(log.find("\n0,0,"), std::string::npos) << log;
  EXPECT_NE(log.find("\n1,0.0333333333,"), std::string::npos) << log;
  EXPECT_NE(log.find("\n2,0.0666666667,"), std::string::npos) << log;
}

TEST(ViewWindow, ResizesAndExplainsItself) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const VirtualDisplay display;
  const ViewSession session(display, folder, {write_moving_scene(folder)});
  const Json large = session.wait_for_picture();
  session.expect_state("help", true, [&] { session.key("question"); });
  session.photograph("help");
  session.expect_state("help", false, [&] { session.key("Escape"); });
  const std::size_t from = session.count();
  const auto resize = [&](const char* width, const char* height) {
    const std::string window = display.run({"xdotool", "search", "--name", "Tenebra"}).output;
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

TEST(ViewWindow, ScalesWithTheDisplay) {
  TENEBRA_NEEDS_A_DISPLAY();
  const TemporaryFolder folder;
  const VirtualDisplay display("2560x1500x24", 192);
  const ViewSession session(display, folder, {write_moving_scene(folder)});
  session.wait_for_picture();
  const auto play = session.place("play");
  EXPECT_NEAR(play[3] - play[1], 2 * 23, 4) << "buttons are twice as large at 192 dots an inch";
  session.photograph("hidpi");
  quit(session);
}

}  // namespace
}  // namespace tenebra::testing
