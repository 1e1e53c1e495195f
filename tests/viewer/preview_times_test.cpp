// Which previews there are, what they leave out, and which is chosen by the times of the last ones.
#include <gtest/gtest.h>

#include <algorithm>

#include "window/frames/preview_times.h"

namespace tenebra::viewer {
namespace {

render::RenderSettings soft_settings() {
  render::RenderSettings settings;
  settings.width = 1024;
  settings.height = 768;
  settings.shadows = render::ShadowMode::soft;
  return settings;
}

PreviewSubject subject_of(const render::RenderSettings& settings, bool compares = false,
                          bool explains = false) {
  static const int scene = 0;
  return preview_subject(&scene, settings, compares, explains);
}

/// What levels take that no clock disturbs.
double true_ms(const std::vector<PreviewLevel>& levels, int level, double whole_ms) {
  constexpr double part[] = {1, 0.5, 0.035, 0.05, 0.01};
  const PreviewLevel at = levels[static_cast<std::size_t>(level)];
  return whole_ms * part[static_cast<std::size_t>(at.method)] / (at.divisor * at.divisor);
}

TEST(PreviewLevels, LeaveOutWhatTheyName) {
  std::vector<render::RenderSettings> asked(7, soft_settings());
  asked[1].soft_points = 4;
  asked[2].soft_points = 1;
  asked[3].ao.mode = AoMode::field;
  asked[4].shadows = render::ShadowMode::hard;
  asked[5].shadows = render::ShadowMode::hard, asked[5].ao.mode = AoMode::rays;
  asked[6].antialias = 4;
  for (const render::RenderSettings& settings : asked) {
    for (const bool compares : {false, true}) {
      for (const bool explains : {false, true}) {
        const auto levels = preview_levels(subject_of(settings, compares, explains));
        ASSERT_GE(levels.size(), 4u);
        EXPECT_EQ(levels.front(), (PreviewLevel{PreviewMethod::as_asked, 1})) << "the whole picture";
        EXPECT_EQ(preview_text(settings, levels.front()), "");
        for (std::size_t i = 1; i < levels.size(); ++i) {
          EXPECT_NE(preview_text(settings, levels[i]), "") << "a preview says what it is";
          EXPECT_EQ(std::count(levels.begin(), levels.end(), levels[i]), 1);
        }
        EXPECT_GE(levels.back().divisor, 8);
      }
    }
  }
  EXPECT_EQ(preview_text(soft_settings(), {PreviewMethod::fewer, 2}), "1/2 size, penumbrae to 4/255");
  EXPECT_EQ(preview_text(soft_settings(), {PreviewMethod::plain, 1}), "hard shadows");
  EXPECT_EQ(preview_text(asked[3], {PreviewMethod::plain, 4}), "1/4 size, hard shadows, no occlusion");
}

TEST(PreviewLevels, NoMethodTakesAnothersPlaceWhereTwoAreComparedOrOneIsExplained) {
  for (const PreviewLevel level : preview_levels(subject_of(soft_settings(), true))) {
    EXPECT_NE(level.method, PreviewMethod::plain);
    EXPECT_NE(level.method, PreviewMethod::cast);
  }
  for (const PreviewLevel level : preview_levels(subject_of(soft_settings(), false, true)))
    EXPECT_LE(level.method, PreviewMethod::single);
}

TEST(PreviewLevels, WholeSettingsAreThoseThatWereAsked) {
  render::RenderSettings asked = soft_settings();
  asked.hard.variant = Variant::spheres;
  asked.ao.mode = AoMode::field;
  asked.ao.rays = 5;
  asked.antialias = 16;
  const render::RenderSettings whole = preview_settings(asked, {});
  EXPECT_EQ(whole.width, asked.width);
  EXPECT_EQ(whole.height, asked.height);
  EXPECT_EQ(whole.soft_points, 0);
  EXPECT_EQ(whole.hard.variant, Variant::spheres);
  EXPECT_EQ(whole.ao.rays, 5);
  EXPECT_EQ(whole.antialias, 16);
  EXPECT_EQ(whole.ao.mode, AoMode::field);
  for (const PreviewLevel level : preview_levels(subject_of(asked))) {
    const render::RenderSettings drawn = preview_settings(asked, level);
    EXPECT_LE(drawn.ao.rays, 8) << "never more than was asked for";
    EXPECT_TRUE(level == PreviewLevel{} || drawn.antialias == 1);
    EXPECT_EQ(drawn.width, 1024 / level.divisor);
    EXPECT_EQ(drawn.height, 768 / level.divisor);
  }
  asked.width = asked.height = 1;
  EXPECT_EQ(preview_settings(asked, {PreviewMethod::plain, 8}).width, 1) << "never nothing";
}

TEST(PreviewLevels, SeeTheSameFieldOfView) {
  const ViewRays view{.eye = {1, 2, 3}, .d0 = {-2, 1, -4}, .dx = {0.004f, 0, 0}, .dy = {0, -0.003f, 0}};
  const ViewRays small = view_in_pixels(view, {1001, 701}, {500, 351});
  EXPECT_EQ(small.d0, view.d0) << "the corner stays";
  EXPECT_NEAR(small.dx.x * 500, view.dx.x * 1001, 1e-6);
  EXPECT_NEAR(small.dy.y * 351, view.dy.y * 701, 1e-6);
}

TEST(PreviewTimes, FindTheFinestLevelWithinTheTime) {
  for (const double whole_ms : {30.0, 100.0, 1000.0, 4000.0, 40000.0}) {
    PreviewTimes times(subject_of(soft_settings()));
    EXPECT_GT(times.choose(80), 0) << "nothing is known: nothing that may take long";
    int level = 0;
    for (int i = 0; i < 50; ++i) {
      level = times.choose(80);
      const double ms = true_ms(times.levels(), level, whole_ms);
      ms > 160 ? times.overran(level, 160) : times.drew(level, ms);
    }
    EXPECT_LE(true_ms(times.levels(), level, whole_ms), 80) << whole_ms;
    for (int finer = 0; finer < level; ++finer)
      EXPECT_GT(true_ms(times.levels(), finer, whole_ms), 0.8 * 80) << whole_ms << ", level " << finer;
  }
}

TEST(PreviewTimes, DoNotSwingBetweenTwoLevels) {
  PreviewTimes times(subject_of(soft_settings()));
  for (int i = 0; i < 20; ++i) times.choose(80), times.drew(0, 78);  // just within the time
  times.choose(80);
  times.drew(0, 200);  // once it is not
  int changes = 0, before = times.choose(80);
  for (int i = 0; i < 100; ++i) {
    const int level = times.choose(80);
    changes += level != before ? 1 : 0;
    before = level;
    times.drew(level, level == 0 ? 78 : 30);
  }
  EXPECT_LE(changes, 2);
}

TEST(PreviewTimes, TryAgainWhatWasTooSlowOnce) {
  PreviewTimes times(subject_of(soft_settings()));
  times.drew(0, 1000);
  int pictures = 0;
  while (times.choose(80) != 0 && pictures < 5000) times.drew(times.choose(80), 20), ++pictures;
  EXPECT_GT(pictures, 50) << "not at every picture";
  EXPECT_LT(pictures, 5000);
}

TEST(PreviewTimes, RefineInStepsThatCostLittle) {
  PreviewTimes times(subject_of(soft_settings()));
  const int last = times.coarsest();
  for (int level = 0; level <= last; ++level) {
    for (int i = 0; i < 20; ++i) times.drew(level, true_ms(times.levels(), level, 4000));
  }
  double on_the_way_ms = 0;
  int shown = last, steps = 0;
  for (; shown > 0 && steps < 20; ++steps) {
    const int next = times.refine(shown);
    ASSERT_LT(next, shown) << "always finer";
    if (next > 0) on_the_way_ms += true_ms(times.levels(), next, 4000);
    shown = next;
  }
  EXPECT_EQ(shown, 0) << "the whole picture in the end";
  EXPECT_LE(on_the_way_ms, 0.5 * 4000);
}

TEST(PreviewTimes, TakeOneSampleFirstWhereThatIsMuchQuicker) {
  render::RenderSettings settings = soft_settings();
  settings.antialias = 4;
  for (const double single_ms : {50.0, 95.0}) {
    PreviewTimes times(subject_of(settings));
    for (int i = 0; i < 20; ++i)
      times.drew(0, 100), times.drew(1, single_ms), times.drew(times.coarsest(), 90);
    EXPECT_GT(times.refine(times.coarsest()), 1) << "a quick step first";
    EXPECT_EQ(times.refine(2), single_ms < 60 ? 1 : 0) << single_ms;
    EXPECT_EQ(times.refine(1), 0);
  }
}

TEST(PreviewTimes, LeaveOutWhatFails) {
  PreviewTimes times(subject_of(soft_settings()));
  const int first = times.choose(80);
  times.failed(first);
  times.drew(times.coarsest(), 1);
  for (int budget_ms = 1; budget_ms < 1000; budget_ms *= 2) EXPECT_NE(times.choose(budget_ms), first);
}

TEST(PreviewMemory, KeepsTheTimesOfTheLastSubjects) {
  PreviewMemory memory;
  const PreviewSubject soft = subject_of(soft_settings());
  memory.of(soft).drew(0, 1000);
  for (int points = 1; points < 8; ++points) {
    render::RenderSettings other = soft_settings();
    other.soft_points = points;
    EXPECT_EQ(memory.of(subject_of(other)).estimate_ms(0), 0);
  }
  EXPECT_GT(memory.of(soft).estimate_ms(0), 0);
  for (int points = 1; points < 20; ++points) {
    render::RenderSettings other = soft_settings();
    other.soft_points = points;
    memory.of(subject_of(other));
  }
  EXPECT_EQ(memory.of(soft).estimate_ms(0), 0) << "not all there ever were";
}

}  // namespace
}  // namespace tenebra::viewer
