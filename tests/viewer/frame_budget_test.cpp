// What --budget chooses, by times that are made up.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "base/fail.h"
#include "commands/frame_budget.h"

namespace tenebra::viewer {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Draws nothing: each error takes what is written here.
struct MadeUp {
  std::vector<double> ms;
  std::vector<std::size_t> drawn;
  std::vector<double> limits;
  int kept = 0;
  std::size_t last_kept = 99;

  bool frame(FrameBudget& budget) {
    drawn.clear(), limits.clear();
    const auto draw = [this](std::size_t rung, double limit_ms) -> Expected<double> {
      drawn.push_back(rung);
      limits.push_back(limit_ms);
      return ms[rung] <= limit_ms ? ms[rung] : never;
    };
    return budget.draw(draw, [this] { ++kept, last_kept = drawn.back(); }).has_value();
  }
};

TEST(FrameBudget, TakesTheSmallestErrorThatFitsThoughTimesDoNotFallEvenly) {
  MadeUp of{{80, 150, 120, 90, 40}};
  FrameBudget hundred(100, 5), sixty(60, 5);
  ASSERT_TRUE(of.frame(hundred));
  EXPECT_EQ(hundred.rung(), 0u) << "exact is quicker than sampling here";
  EXPECT_EQ(of.drawn, (std::vector<std::size_t>{4, 0})) << "the coarsest first, for what is built once";
  ASSERT_TRUE(of.frame(sixty));
  EXPECT_EQ(sixty.rung(), 4u);
  EXPECT_TRUE(sixty.fits());
  EXPECT_EQ(of.drawn, (std::vector<std::size_t>{4, 0, 3, 4})) << "exact, then by halves";
}

TEST(FrameBudget, KeepsTheErrorOfTheLastFrameUpToATenth) {
  MadeUp of{{200, 150, 95, 60}};
  FrameBudget budget(100, 4);
  ASSERT_TRUE(of.frame(budget));
  EXPECT_EQ(budget.rung(), 2u);
  of.ms[2] = 109;
  ASSERT_TRUE(of.frame(budget));
  EXPECT_EQ(of.drawn, std::vector<std::size_t>{2});
  EXPECT_TRUE(budget.fits());
  of.ms[2] = 111;
  ASSERT_TRUE(of.frame(budget));
  EXPECT_EQ(budget.rung(), 3u);
  EXPECT_EQ(of.last_kept, 3u);
}

TEST(FrameBudget, TriesSmallerErrorsWhereFramesGetQuickerAndEveryNowAndThen) {
  MadeUp of{{200, 150, 90}};
  FrameBudget budget(100, 3);
  ASSERT_TRUE(of.frame(budget));
  ASSERT_TRUE(of.frame(budget));
  EXPECT_EQ(of.drawn, std::vector<std::size_t>{2});
  of.ms = {160, 95, 70};
  ASSERT_TRUE(of.frame(budget));
  EXPECT_EQ(of.drawn, (std::vector<std::size_t>{2, 0, 1}));
  EXPECT_EQ(budget.rung(), 1u);
  of.ms[0] = 99;
  int frames = 1;
  for (; budget.rung() != 0 && frames < 100; ++frames) ASSERT_TRUE(of.frame(budget));
  EXPECT_LE(frames, 26);
}

TEST(FrameBudget, TakesTheCoarsestWhereNothingFitsAndTriesAgainLater) {
  MadeUp of{{200, 150, 130}};
  FrameBudget budget(100, 3);
  ASSERT_TRUE(of.frame(budget));
  EXPECT_FALSE(budget.fits());
  EXPECT_EQ(budget.rung(), 2u);
  EXPECT_EQ(of.last_kept, 2u);
  ASSERT_TRUE(of.frame(budget));
  EXPECT_EQ(of.drawn, std::vector<std::size_t>{2}) << "not all of them for each frame";
  of.ms[1] = 90;
  for (int frames = 0; budget.rung() != 1 && frames < 100; ++frames) ASSERT_TRUE(of.frame(budget));
  EXPECT_TRUE(budget.fits());
}

TEST(FrameBudget, TakesTheQuickestWhereNothingFitsThoughItIsNotTheCoarsest) {
  MadeUp of{{170, 140, 150, 140, 300}};
  FrameBudget budget(100, 5);
  ASSERT_TRUE(of.frame(budget));
  EXPECT_FALSE(budget.fits());
  EXPECT_EQ(budget.rung(), 1u) << "of two as quick the smaller error";
  EXPECT_EQ(of.last_kept, 1u);
  ASSERT_TRUE(of.frame(budget));
  EXPECT_EQ(of.drawn, std::vector<std::size_t>{1}) << "until the next search";
  of.ms = {170, 109, 150, 105, 108};
  FrameBudget almost(100, 5);
  ASSERT_TRUE(of.frame(almost));
  EXPECT_TRUE(almost.fits()) << "up to a tenth above the budget";
  EXPECT_EQ(almost.rung(), 1u) << "the smallest of those, not the quickest";
}

TEST(FrameBudget, LimitsTheFirstFrameAndGoesOnWithoutIt) {
  MadeUp of{{50, 20, 9000}};
  FrameBudget budget(60, 3);
  ASSERT_TRUE(of.frame(budget)) << "the coarsest was given up";
  EXPECT_EQ(of.limits.front(), 2600);
  EXPECT_EQ(of.drawn, (std::vector<std::size_t>{2, 0}));
  EXPECT_EQ(budget.tries().size(), 1u) << "the first is not counted";
}

/// The time of each of 14 errors: any order of falling, rising and chance.
std::vector<double> some_times(std::uint32_t seed) {
  std::vector<double> ms(14);
  for (std::size_t rung = 0; rung < ms.size(); ++rung) {
    seed = seed * 1664525u + 1013904223u;
    ms[rung] = 40 + 12 * static_cast<double>(14 - rung) + (seed >> 24) * 0.6;
  }
  return ms;
}

TEST(FrameBudget, TriesAtMostEightWhateverFramesTake) {
  for (const double budget_ms : {1.0, 90.0, 130.0, 170.0, 1000.0}) {
    MadeUp of;
    FrameBudget budget(budget_ms, 14);
    for (std::uint32_t frame = 0; frame < 200; ++frame) {
      of.ms = some_times(frame);
      ASSERT_TRUE(of.frame(budget));
      ASSERT_LE(budget.tries().size(), FrameBudget::most_tries) << budget_ms << " " << frame;
      ASSERT_EQ(of.last_kept, budget.rung());
      ASSERT_EQ(budget.fits(), budget.ms() <= 1.1 * budget_ms);
      ASSERT_EQ(budget.ms(), of.ms[budget.rung()]);
    }
  }
}

TEST(FrameBudget, FindsTheSmallestErrorWhereTimesFall) {
  for (std::size_t least = 0; least < 14; ++least) {
    MadeUp of;
    for (std::size_t rung = 0; rung < 14; ++rung) of.ms.push_back(rung < least ? 200 : 50);
    FrameBudget budget(100, 14);
    ASSERT_TRUE(of.frame(budget));
    EXPECT_EQ(budget.rung(), least);
    EXPECT_TRUE(budget.fits());
    EXPECT_LE(budget.tries().size(), 5u);
  }
}

TEST(FrameBudget, HandsOnWhyNothingWasDrawn) {
  FrameBudget budget(100, 3);
  const auto fails = [](std::size_t, double) -> Expected<double> { return base::stopped(); };
  const auto done = budget.draw(fails, [] { FAIL() << "nothing to keep"; });
  ASSERT_FALSE(done);
  EXPECT_TRUE(is_stop(done));
}

TEST(FrameBudget, HasNoErrorBelowThoseOfQuality) {
  MethodOptions options;
  options.render.shadows = render::ShadowMode::soft;
  EXPECT_EQ(budget_ladder(options).front().soft, 0);
  options.render.ao.mode = AoMode::adaptive;
  EXPECT_EQ(budget_ladder(options).front(), (BudgetErrors{0, 0.5}));
  EXPECT_EQ(budget_ladder(options).back(), (BudgetErrors{16, 16}));
  options.quality = settings::Quality::fast;
  settings::apply_quality(*options.quality, options.render);
  EXPECT_EQ(budget_ladder(options).front(), (BudgetErrors{4, 5}));
  options.render.shadows = render::ShadowMode::hard;
  EXPECT_EQ(budget_ladder(options).front(), (BudgetErrors{0, 5}));
  EXPECT_EQ(budget_ladder(options).size(), 5u) << "none twice";
}

}  // namespace
}  // namespace tenebra::viewer
