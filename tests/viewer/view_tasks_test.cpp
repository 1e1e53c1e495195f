// Five tasks of a user, each by real key and mouse events: open and frame a model, find why a pixel is dark,
// move the sun, compare two methods, record an animation.
#include <gtest/gtest.h>

#include "window_steps.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;

void wait_for_state(const ViewSession& session, const char* key, const Json& value) {
  session.wait_until(key, [&] { return session.state()[key] == value; });
}

/// The moving scene from straight above: 43.3 pixels a metre on the floor, its middle at (200, 200).
std::vector<std::string> from_above(const fs::path& scene) {
  return {scene,    "--eye", "0,8,0.001", "--look-at", "0,0,0",  "--up",
          "0,0,-1", "--fov", "60",        "--size",    "400x400"};
}

/// The event of the explanation of a pixel of the picture, after a click on it or the key.
Json explained_at(const ViewSession& session, int x, int y, bool by_key) {
  const auto place = session.place("picture");
  const std::size_t from = session.count();
  session.move_to(place[0] + x, place[1] + y);
  if (by_key) {
    session.key("i");
  } else {
    session.press();
    session.release();
  }
  return session.wait_for(from, "the explanation", [&](const Json& event) {
    return event["event"] == "explained" && event["pixel"] == Json({x, y});
  });
}

using ViewTasks = WindowTest;

TEST_F(ViewTasks, OpensAndFramesAModel) {
  const TemporaryFolder others;
  const std::string first = write_moving_scene(folder_), settings = folder_ / "kept/viewer.json";
  const std::string other = fs::canonical(write_moving_scene(others, 2));
  {
    const ViewSession session(display(), folder_,
                              {first, "--settings", settings, "--eye", "3,40,5", "--look-at", "9,0,0"});
    session.wait_for_picture();
    std::size_t from = session.count();
    session.key("ctrl+o");
    session.place("open.typed");
    session.photograph("task_open");
    session.xdotool({"type", "--delay", "20", other});
    session.key("Return");
    EXPECT_EQ(session.wait_for_event(from, "opened")["file"], other);
    session.wait_until_gone("open.typed");
    session.wait_for_picture();
    session.expect_state("camera", "orbit", [&] { session.key("g"); });
    session.wait_for_picture();
    session.photograph("task_framed");
    const std::string camera = session.state()["free"];
    EXPECT_NE(camera.find("--look-at 0,0.5,0 "), std::string::npos) << camera;
    session.expect_state("camera", "scene", [&] { session.key("BackSpace"); });
    session.expect_state("camera", "orbit", [&] { session.click("see all"); });
    quit(session);
  }
  const ViewSession session(display(), folder_,
                            {other, "--settings", settings});  // the first by hand, as a recent one
  session.wait_for_picture();
  const std::size_t from = session.count();
  session.click("open");
  session.wait_until("two recent scenes", [&] {
    const Json marks = session.marks();
    std::size_t recent = 0;
    for (const auto& [name, place] : marks.items()) recent += name.starts_with("open.row.recent");
    return recent >= 1;
  });
  session.key("Down");
  session.key("Return");
  EXPECT_EQ(session.wait_for_event(from, "opened")["file"], fs::absolute(first).lexically_normal().string());
  quit(session);
}

TEST_F(ViewTasks, FindsWhyAPixelIsDark) {
  std::vector<std::string> arguments = from_above(write_moving_scene(folder_));
  arguments.insert(arguments.end(), {"--shots", folder_ / "shot_%d.png"});
  const ViewSession session(display(), folder_, arguments);
  session.wait_for_picture();
  const io::Image8 picture = shot(session);
  const auto brightness = [&](int x, int y) {
    return picture.pixels[static_cast<std::size_t>(y * 400 + x) * 3];
  };
  for (const bool by_key : {false, true}) {
    const Json dark = explained_at(session, 150, 258, by_key);
    ASSERT_EQ(dark["background"], false);
    EXPECT_EQ(dark["node"], 0) << "the floor";
    EXPECT_EQ(dark["lights"][0]["sight"], "blocked");
    EXPECT_EQ(dark["lights"][0]["occluder"], 2);
    EXPECT_EQ(dark["lights"][0]["occluder_node"], 1);
    session.place("why.occluder.0");
    const Json lit = explained_at(session, 250, 258, by_key);
    EXPECT_EQ(lit["node"], 0);
    EXPECT_EQ(lit["lights"][0]["sight"], "lit");
    EXPECT_FALSE(lit["lights"][0].contains("occluder"));
    EXPECT_LT(2 * brightness(150, 258), brightness(250, 258)) << "as the picture has it";
  }
  explained_at(session, 150, 258, false);
  session.photograph("task_why");
  session.expect_state("selected_node", 1, [&] { session.click("why.occluder.0"); });
  session.expect_state("selected_material", 0, [&] { session.click("why.material"); });
  session.photograph("task_why_node");

  // The node that is in the way is taken out by its box in the tree: the answer follows by itself.
  std::size_t from = session.count();
  session.click("node.1.casts");
  session.wait_for(from, "a free way", [](const Json& event) {
    return event["event"] == "explained" && event["lights"][0]["sight"] == "lit";
  });
  session.key("Escape");
  session.wait_until_gone("why");
  quit(session);
}

TEST_F(ViewTasks, MovesTheSun) {
  const std::string scene = write_moving_scene(folder_);
  const ViewSession session(display(), folder_,
                            {scene, "--add-light", "directional direction=-1,-2,-0.5 intensity=0.5",
                             "--shots", folder_ / "shot_%d.png", "--eye", "0,4,9", "--look-at", "0,1,0"});
  session.wait_for_picture();
  const Json before = session.state()["edits"];
  const auto sun = session.place("light.1");
  session.drag("light.1", -30, 12);
  session.wait_for_picture();
  const Json turned = session.state()["edits"];
  EXPECT_NE(turned.dump().find("--set-light 1 direction="), std::string::npos) << turned;
  EXPECT_NEAR(session.place("light.1")[0], sun[0] - 30, 2) << "the sun is under the hand";
  EXPECT_EQ(session.state()["selected_light"], 1);
  session.photograph("task_sun");
  session.expect_state("edits", before, [&] { session.key("ctrl+z"); });
  session.expect_state("edits", turned, [&] { session.key("ctrl+shift+z"); });

  // By keys alone: into the panel, down to a slider of the sun, and a push of it.
  session.click("section.Lights");
  session.click("light.1.compass");
  session.key("F6");
  const Json slid = session.state()["edits"];
  session.move_to("light.1.height", 0.8);
  session.press();
  session.release();
  EXPECT_NE(session.state()["edits"], slid);
  session.expect_state("a", "--shadows none", [&] { session.click("shadows.none"); });
  std::size_t from = session.count();
  session.key("Right");
  session.key("space");
  session.wait_for(from, "hard shadows by keys", [](const Json& event) {
    return event["event"] == "state" && event["a"].get<std::string>().find("none") == std::string::npos;
  });
  EXPECT_EQ(session.state()["playing"], false) << "the keys belonged to the panel";
  session.key("Escape");
  session.expect_state("playing", true, [&] { session.key("space"); });
  session.expect_state("playing", false, [&] { session.key("space"); });

  session.wait_for_picture();
  EXPECT_EQ(shot(session), pasted(folder_, scene, copied_arguments(session)));
  quit(session);
}

TEST_F(ViewTasks, EditsMaterialsAndLights) {
  const std::string scene = write_moving_scene(folder_);
  const ViewSession session(display(), folder_, {scene, "--shots", folder_ / "shot_%d.png"});
  session.wait_for_picture();
  const io::Image8 before = shot(session);
  session.click("section.Lights");
  session.click("add.sun");
  wait_for_state(session, "selected_light", 1);
  EXPECT_NE(session.state()["edits"].dump().find("--add-light directional"), std::string::npos);
  session.wait_for_picture();
  EXPECT_NE(shot(session), before);
  session.click("light.0.delete");
  session.wait_until_gone("light.0.delete");
  session.wait_for_picture();
  session.click("section.Lights");
  session.click("section.Materials");
  session.click("material");
  session.click("material.0");
  wait_for_state(session, "selected_material", 0);
  session.move_to("material.roughness", 0.1);
  session.press();
  session.release();
  session.wait_until("an edited material", [&] {
    return session.state()["edits"].dump().find("--set-material 0 roughness=") != std::string::npos;
  });
  session.photograph("task_material");
  session.wait_for_picture();
  const io::Image8 edited = shot(session);
  EXPECT_EQ(edited, pasted(folder_, scene, copied_arguments(session)));
  for (int i = 0; i < 3; ++i) session.click("undo");
  wait_for_state(session, "edits", Json::array());
  session.wait_for_picture();
  EXPECT_EQ(shot(session), before);
  quit(session);
}

TEST_F(ViewTasks, ComparesTwoMethodsByMouse) {
  const ViewSession session(display(), folder_, {write_moving_scene(folder_)});
  session.wait_for_picture();
  session.click("section.Compare");
  session.expect_state("compare", true, [&] { session.click("compare"); });
  session.expect_state("active", 1, [&] { session.click("slot.B"); });
  session.expect_state("b", "--shadows none", [&] { session.click("shadows.none"); });
  session.expect_state("show", "difference", [&] { session.click("show.diff"); });
  EXPECT_GT(session.wait_for_picture()["differing"], 100);
  session.photograph("task_compare");
  quit(session);
}

TEST_F(ViewTasks, RecordsAnAnimation) {
  const std::string scene = write_moving_scene(folder_);
  const ViewSession session(display(), folder_, {scene, "--size", "80x60"});
  session.wait_for_picture();
  session.key("End");
  std::size_t from = session.count();
  session.click("record");
  session.wait_for(from, "the end of the recording", [](const Json& event) {
    return event["event"] == "message" && event["text"].get<std::string>().starts_with("Recorded to");
  });
  const fs::path pictures = folder_ / "tenebra_frames";
  EXPECT_EQ(std::distance(fs::directory_iterator(pictures), fs::directory_iterator()), moving_scene_frames);
  EXPECT_EQ(session.state()["loop"], true) << "the clock is as it was";
  from = session.count();
  session.key("o");
  session.key("o");
  session.wait_for(from, "its end by hand", [](const Json& event) {
    return event["event"] == "message" && event["text"].get<std::string>().starts_with("Recording ended");
  });
  EXPECT_TRUE(fs::exists(folder_ / "tenebra_frames_2")) << "the first recording stays";
  quit(session);
  const auto rendered =
      tenebra({"render", scene, "--size", "80x60", "--frames", "7", "-o", folder_ / "seven.png"});
  ASSERT_EQ(rendered.exit_code, 0) << rendered.errors;
  EXPECT_EQ(picture_of(pictures / "0007.png"), picture_of(folder_ / "seven.png"));
}

}  // namespace
}  // namespace tenebra::testing
