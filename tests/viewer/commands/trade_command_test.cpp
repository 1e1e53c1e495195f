// tenebra trade: the arithmetic of fronts, and the command on a small scene.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "trade/trade_choice.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

using viewer::TradeAxes;
using viewer::TradePoint;

TradePoint traded(double ms, double error) {
  return {{}, ms, error};
}

TEST(TradeFront, HasWhatNothingBeats) {
  const std::vector<TradePoint> points{traded(5, 1), traded(1, 9), traded(2, 9), traded(3, 4),
                                       traded(3, 5), traded(6, 1), traded(7, 0), traded(4, 4)};
  EXPECT_EQ(viewer::pareto_front(points), (std::vector<std::size_t>{1, 3, 0, 6}));
  EXPECT_TRUE(viewer::pareto_front({}).empty());
  const std::vector<TradePoint> same(3, traded(2, 2));
  EXPECT_EQ(viewer::pareto_front(same), std::vector<std::size_t>{0}) << "of equal ones the first";
}

TEST(TradeFront, IsThinnedEvenlyAndKeepsItsEnds) {
  std::vector<TradePoint> points;
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < 100; ++i) {
    points.push_back(traded(std::pow(1.05, double(i)), 100.0 - double(i)));
    front.push_back(i);
  }
  EXPECT_EQ(viewer::thinned(points, front, 4), (std::vector<std::size_t>{0, 33, 66, 99}));
  EXPECT_EQ(viewer::thinned(points, front, 100), front);
}

TEST(TradeSweep, AddsTimesAndSquaresOfErrors) {
  viewer::TradeSweep sweep;
  sweep.antialias = {{{1, 8, 5}, 10, 3}, {{4, 8, 5}, 14, 0}};
  sweep.soft = {{{1, 8, 5}, 10, 4}, {{1, 0, 5}, 30, 0}};
  sweep.ao = {{{1, 8, 5}, 10, 0}};
  const auto points = viewer::predicted_points(sweep);
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[0].ms, 10);
  EXPECT_EQ(points[0].error, 5) << "3 and 4";
  EXPECT_EQ(points[3].setting, (viewer::TradeSetting{4, 0, 5}));
  EXPECT_EQ(points[3].ms, 34);
  EXPECT_EQ(points[3].error, 0);
}

TEST(TradeSweep, ChangesWhatThereIsToChoose) {
  TradeAxes axes;
  axes.soft_errors = {8, 0};
  render::RenderSettings given;
  given.antialias = 2;
  given.ao.error_255 = 3;
  const render::RenderSettings settings = viewer::with_setting(given, axes, viewer::coarsest(axes));
  EXPECT_EQ(settings.antialias, 2);
  EXPECT_EQ(settings.soft.error_255, 8);
  EXPECT_EQ(settings.ao.error_255, 3);
}

viewer::TradedSetting measured(double ms, double error, double worst = 0) {
  viewer::TradedSetting setting;
  setting.point = traded(ms, error);
  setting.worst_error = worst;
  return setting;
}

/// Three settings of the front, and one that is not on it.
viewer::TradeResult measured_front() {
  viewer::TradeResult result;
  result.measured = {measured(10, 4, 5), measured(20, 1, 1), measured(25, 2, 3), measured(60, 0, 0)};
  result.front = {0, 1, 3};
  return result;
}

TEST(TradeChoice, AllowsForErrorsOfFramesThatWereNotTried) {
  viewer::TradeResult result = measured_front();
  result.spread = 1.5;
  EXPECT_DOUBLE_EQ(viewer::promised_error(result, result.measured[0]), 9);
  EXPECT_DOUBLE_EQ(viewer::promised_error(result, result.measured[1]), 1.8);
  EXPECT_EQ(viewer::promised_error(result, result.measured[3]), 0);
  EXPECT_EQ(viewer::within_error(result, 8), &result.measured[1]);
  EXPECT_EQ(viewer::within_error(result, 1), &result.measured[3]);
  result.measured.pop_back();
  EXPECT_EQ(viewer::within_error(result, 1), nullptr);
}

/// Which of measured_front() is chosen where frames that were not tried take `more` times as long.
struct Choice {
  std::optional<std::size_t> setting;
  double ms = 0;
  std::vector<double> timed;  ///< settings, by the time of the frames that were tried
};
Choice choose(double budget_ms, double more) {
  const viewer::TradeResult result = measured_front();
  Choice choice;
  const auto found = viewer::within_budget(result, budget_ms, [&](const TradePoint& point) {
    choice.timed.push_back(point.ms);
    return Expected<double>(point.ms * more);
  });
  choice.ms = found->ms;
  if (found->setting != nullptr) choice.setting = found->setting - result.measured.data();
  return choice;
}

// Found on BART's museum: its tried frames had half as much to draw as those that were not.
TEST(TradeChoice, TakesAQuickerSettingWhereOtherFramesTakeLonger) {
  const Choice quicker = choose(25, 2);
  EXPECT_EQ(quicker.setting, 0u);
  EXPECT_EQ(quicker.ms, 20);
  EXPECT_EQ(quicker.timed, (std::vector<double>{20, 10})) << "none twice, and not the finest";
  const Choice none = choose(15, 2);
  EXPECT_EQ(none.setting, std::nullopt);
  EXPECT_EQ(none.ms, 20) << "of the quickest";
  EXPECT_EQ(choose(5, 0.4).setting, 0u) << "which fits by frames that were not tried alone";
}

// Found on Fox, the robots and the gallery: the next finer setting would have fitted too.
TEST(TradeChoice, TakesAFinerSettingWhereOtherFramesTakeLessTime) {
  const Choice finest = choose(15, 0.2);
  EXPECT_EQ(finest.setting, 3u);
  EXPECT_EQ(finest.ms, 12);
  EXPECT_EQ(finest.timed, (std::vector<double>{10, 20, 60})) << "none that is not on the front";
  EXPECT_EQ(choose(25, 1).setting, 1u) << "the next takes longer";
}

TEST(TradeChoice, DecidesInTheMiddleOfTheTenthThatABudgetMayBeExceededBy) {
  EXPECT_EQ(choose(20, 1.04).setting, 1u);
  EXPECT_EQ(choose(20, 1.06).setting, 0u);
}

TEST(TradeChoice, FailsWhereTimingDoes) {
  for (const double fails_at : {20, 60}) {
    const auto found =
        viewer::within_budget(measured_front(), 20, [&](const TradePoint& point) -> Expected<double> {
          if (point.ms == fails_at) return tl::unexpected(Error{"stopped", ErrorKind::stopped});
          return point.ms;
        });
    ASSERT_FALSE(found) << fails_at;
    EXPECT_TRUE(is_stop(found));
  }
}

TEST(TradeCommand, FindsTheFrontOfASceneAndWritesItsPage) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto result = tenebra({"trade", scene, "--shadows", "soft", "--light-size", "1x1", "--size", "48x36",
                               "--repeats", "1", "--json", "-o", folder / "page.html", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["frames"].size(), 3u);
  const auto& settings = json["settings"];
  // So few triangles take no time that could be told apart, and are solved exactly whatever error is asked
  // for: which settings are on the front, beside one without error, is chance.
  ASSERT_GE(settings.size(), 2u) << "the standard one and one without error";
  EXPECT_TRUE(std::ranges::any_of(settings, [](const auto& setting) {
    return setting["options"] == "--antialias 4 --soft-error 0";
  })) << "the standard one";
  EXPECT_TRUE(std::ranges::any_of(settings, [](const auto& setting) {
    return setting["error_255"] == 0.0 &&
           setting["options"].template get<std::string>().starts_with("--antialias 16 --soft-error ");
  })) << "the finest, again";
  double ms = 0, error = HUGE_VAL;
  for (const auto& setting : settings) {
    if (!setting["front"]) continue;
    EXPECT_GE(setting["frame_ms"], ms);
    EXPECT_LT(setting["error_255"], error);
    EXPECT_GE(setting["worst_frame_error_255"], setting["error_255"]);
    ms = setting["frame_ms"], error = setting["error_255"];
  }
  EXPECT_EQ(error, 0);
  const std::string page = read_text(folder / "page.html");
  EXPECT_NE(page.find("--antialias 16 --soft-error "), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos) << "needs no network";
}

TEST(TradeCommand, PrintsTheSettingThatFits) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const std::vector<std::string> common{"trade", scene,       "--time", "1",      "--size",
                                        "48x36", "--repeats", "1",      "--quiet"};
  const auto run = [&](std::initializer_list<std::string> more) {
    std::vector<std::string> arguments = common;
    arguments.insert(arguments.end(), more);
    return tenebra(arguments);
  };
  const auto best = run({"--budget", "1e6"});
  EXPECT_EQ(best.exit_code, 0) << best.errors;
  EXPECT_NE(best.output.find("\n\ntenebra render "), std::string::npos) << best.output;
  EXPECT_TRUE(best.output.ends_with("--antialias 16\n")) << best.output;
  const auto moving =
      tenebra({"trade", scene, "--size", "48x36", "--repeats", "1", "--budget", "1e6", "--quiet"});
  EXPECT_EQ(moving.exit_code, 0) << moving.errors;
  EXPECT_TRUE(moving.output.ends_with("--antialias 16\n")) << "timed on other frames: " << moving.output;
  const auto none = run({"--budget", "1e-6"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_TRUE(is_one_sentence(none.errors)) << none.errors;
  const auto given = run({"--antialias", "2", "--error", "1"});
  EXPECT_EQ(given.exit_code, 0) << given.errors;
  EXPECT_TRUE(given.output.ends_with("--antialias 2\n")) << "nothing to choose: " << given.output;
  const auto over = tenebra({"trade", scene, "-o", scene});
  EXPECT_EQ(over.exit_code, 1) << "never over what it reads";
}

}  // namespace
}  // namespace tenebra::testing
