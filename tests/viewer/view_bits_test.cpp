// What the window shows, saves, records and logs is what `tenebra render` writes, bit by bit.
#include <gtest/gtest.h>

#include "window_steps.h"

namespace tenebra::testing {
namespace {

/// The part of a picture of the window that shows the scene.
io::Image8 cut(const io::Image8& window, const std::array<double, 4>& place) {
  const auto [left, top, right, bottom] = place;
  io::Image8 out{static_cast<int>(right - left), static_cast<int>(bottom - top), window.channels, {}};
  for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y) {
    const auto row =
        window.pixels.begin() + (static_cast<std::ptrdiff_t>(y) * window.width + static_cast<int>(left)) * 3;
    out.pixels.insert(out.pixels.end(), row, row + static_cast<std::ptrdiff_t>(out.width) * 3);
  }
  return out;
}

io::Image8 rendered(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "render");
  arguments.insert(arguments.end(), {"-o", folder / "rendered.png", "--quiet"});
  const auto result = tenebra(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return picture_of(folder / "rendered.png");
}

using ViewWindow = WindowTest;

TEST_F(ViewWindow, ShowsTheBitsOfRender) {
  const std::string scene = write_moving_scene(folder_, 2);
  const std::vector<std::vector<std::string>> methods{
      {"--shadows", "none"},
      {"--shadows", "hard"},
      {"--shadows", "hard", "--paper", "variant=Spheres", "--exposure", "2"},
      {"--shadows", "soft", "--light-size", "1x0.5"},
      {"--shadows", "soft", "--set-light", "1 size=1x0.5 move=0,0.5,0.25 intensity=2", "--set-light",
       "0 on=0"},
      {"--shadows", "hard", "--ao", "rays", "--ao-rays", "16", "--eye", "3,4,5", "--look-at", "0,0,0"},
      {"--shadows", "none", "--ao", "field", "--paper", "ao-positions=100", "--paper", "ao-directions=64",
       "--ao-cache", "none"}};
  for (const auto& method : methods) {
    std::vector<std::string> arguments{scene, "--time", "2.125", "--size", "400x300"};
    arguments.insert(arguments.end(), method.begin(), method.end());
    const io::Image8 expected = rendered(folder_, arguments);
    arguments.insert(arguments.end(), {"--shots", folder_ / "shot_%d.png"});
    const ViewSession session(display(), folder_, arguments);
    session.wait_for_picture();
    // The lights' circles lie over the picture: they go for the comparison, and messages by themselves.
    session.click("section.Lights");
    session.click("circles");
    session.move_to("scrubber");
    session.wait_for_picture();
    session.wait_until_gone("message");
    const io::Image8 window = shot(session, "shift+p");
    EXPECT_EQ(cut(window, session.place("picture")), expected) << "pixels of the window, " << method[1];
    EXPECT_EQ(shot(session), expected) << method[1];
    quit(session);
  }
}

TEST_F(ViewWindow, CopiesWhatItShowsForRender) {
  const std::string scene = write_moving_scene(folder_);
  const ViewSession session(display(), folder_,
                            {scene, "--shots", folder_ / "shot_%d.png", "--light-size", "0.5", "--eye",
                             "0,3,9", "--look-at", "0,1,0"});
  session.wait_for_picture();
  session.key("3");
  session.click("section.Lights");
  session.move_to("light.0.size", 0.25);
  session.press();
  session.move_to(session.place("light.0.size")[0] + 120, session.place("light.0.size")[1] + 8);
  session.release();
  session.drag("light.0", 40, 0);
  EXPECT_NE(session.state()["lights"].dump().find("size="), std::string::npos) << session.state()["lights"];
  const std::string start = session.state()["free"];
  session.drag(300, 300, 71, -17);
  EXPECT_NE(session.state()["free"], start);
  session.wait_for_picture();
  const std::string copied = copied_arguments(session);
  for (const char* option : {"--eye", "--time", "--size", "--shadows soft", "--set-light '0 move="}) {
    EXPECT_NE(copied.find(option), std::string::npos) << copied;
  }
  EXPECT_EQ(shot(session), pasted(folder_, scene, copied));
  quit(session);
}

TEST_F(ViewWindow, ShowsMarkedPreviewsWhileAKeyIsHeldAndRefinesThem) {
  const std::string scene = TENEBRA_SCENES_DIR "/court.glb";
  const ViewSession session(
      display(), folder_,
      {scene, "--shadows", "soft", "--size", "640x480", "--shots", folder_ / "shot_%d.png"});
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
  const io::Image8 saved = shot(session);  // waits for the whole picture
  session.wait_for_picture();
  session.wait_until_gone("preview");
  EXPECT_EQ(saved, pasted(folder_, scene, copied_arguments(session))) << "refined to the bits of render";
  quit(session);
}

TEST_F(ViewWindow, LogsRecordsAndLeaves) {
  const std::string scene = write_moving_scene(folder_);
  const ViewSession session(display(), folder_,
                            {scene, "--size", "160x120", "--shadows", "soft", "--light-size", "1x1",
                             "--quality", "fast", "--record", folder_ / "out/%04d.png", "--exit-after", "4"});
  EXPECT_EQ(session.wait().exit_code, 0);
  const auto render =
      tenebra({"render", scene, "--size", "160x120", "--shadows", "soft", "--light-size", "1x1",
               "--soft-error", "4", "--frames", "0:3", "-o", folder_ / "render/%04d.png"});
  ASSERT_EQ(render.exit_code, 0) << render.errors;
  for (const char* name : {"0000.png", "0001.png", "0002.png", "0003.png"}) {
    EXPECT_EQ(picture_of(folder_ / "out" / name), picture_of(folder_ / "render" / name)) << name;
  }

  const ViewSession logging(display(), folder_,
                            {scene, "--size", "160x120", "--log", folder_ / "frames.csv"});
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
  const std::string log = read_text(folder_ / "frames.csv");
  const std::string render_log = [&] {
    tenebra({"render", scene, "--size", "160x120", "-o", "none", "--log", folder_ / "render.csv"});
    return read_text(folder_ / "render.csv");
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

}  // namespace
}  // namespace tenebra::testing
