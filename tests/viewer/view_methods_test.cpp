// Every method by its button and key, and two of them beside each other, in the window on a virtual display.
#include <gtest/gtest.h>

#include "window_steps.h"

namespace tenebra::testing {
namespace {

using ViewWindow = WindowTest;

TEST_F(ViewWindow, FlipsEveryMethod) {
  const ViewSession session(display(), folder_,
                            {write_moving_scene(folder_), "--ao-cache", "none", "--light-size", "1x1",
                             "--shots", folder_ / "shot_%d.png"});
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
  shows("solver.bsp", "--paper soft-solver=bsp");
  shows("solver.clip", "--paper soft-solver=clip");
  shows("grouping.triangle", "--paper soft-grouping=triangle");
  EXPECT_GT(shows("ao.rays", "--ao rays")["ao_points"], 0);
  EXPECT_GT(shows("ao.adaptive", "--ao adaptive")["ao_points"], 0);
  EXPECT_GT(shows("ao.field", "--ao field")["ao_points"], 0);
  session.photograph("method_ao");
  const Json fast =
      shows("quality.fast", "--soft-error 4 --ao field --ao-error 5 --ao-rays 16 --paper ao-downscale=2");
  EXPECT_GT(fast["soft_groups"], 0) << "exact where few triangles are in the way";
  EXPECT_GT(shows("quality.exact", "--ao field --ao-error 1 --ao-rays 256")["soft_groups"], 0);
  session.click("quality.balanced");
  session.wait_for_picture();
  session.click("ao.none");
  session.click("shadows.hard");
  session.wait_for_picture();
  shows("samples.depth", "--paper samples=depth");
  session.click("samples.ids");
  session.wait_for_picture();

  const io::Image8 before = shot(session);
  std::vector<std::string> variants;
  for (int i = 0; i < 8; ++i) {
    const std::size_t from = session.count();
    session.key("v");
    const Json state = session.wait_for_event(from, "state");
    variants.push_back(state["a"]);
    session.wait_for_picture();
    EXPECT_EQ(shot(session), before) << "the same mask by " << state["a"];
  }
  std::sort(variants.begin(), variants.end());
  EXPECT_EQ(std::unique(variants.begin(), variants.end()) - variants.begin(), 8)
      << "Tiles and the seven in turn";

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

TEST_F(ViewWindow, ComparesTwoMethods) {
  const ViewSession session(
      display(), folder_, {write_moving_scene(folder_), "--compare=--shadows none", "--show", "difference"});
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
  session.drag((wipe[0] + wipe[2]) / 2, (wipe[1] + wipe[3]) / 3, 120, 0);
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

}  // namespace
}  // namespace tenebra::testing
