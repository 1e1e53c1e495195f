#include "base/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace tenebra {
namespace {

TEST(Summarize, IsZeroForNoFrames) {
  const base::Summary summary = base::summarize({});
  EXPECT_EQ(summary.count, 0u);
  EXPECT_EQ(summary.median, 0.0);
  EXPECT_EQ(summary.worst, 0.0);
}

TEST(Summarize, IsTheValueItselfForOneFrame) {
  const base::Summary summary = base::summarize(std::vector<double>{7.5});
  EXPECT_EQ(summary.median, 7.5);
  EXPECT_EQ(summary.percentile_95, 7.5);
  EXPECT_EQ(summary.percentile_99, 7.5);
  EXPECT_EQ(summary.worst, 7.5);
  EXPECT_EQ(summary.worst_at, 0u);
}

TEST(Summarize, GivesTheRanksOfAHundredFrames) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  const base::Summary summary = base::summarize(values);
  EXPECT_EQ(summary.median, 50.5);
  EXPECT_EQ(summary.percentile_95, 95.0);
  EXPECT_EQ(summary.percentile_99, 99.0);
  EXPECT_EQ(summary.worst, 100.0);
  EXPECT_EQ(summary.worst_at, 0u);
}

TEST(Summarize, NamesTheFirstOfEquallyBadFrames) {
  EXPECT_EQ(base::summarize(std::vector<double>{1, 9, 2, 9}).worst_at, 1u);
}

TEST(Summarize, PercentilesAreTheSmallestValuesThatCoverTheirShare) {
  std::mt19937 random(5);
  for (std::size_t count = 1; count <= 250; ++count) {
    std::vector<double> values(count);
    for (double& value : values) value = static_cast<double>(random() % 1000);
    const base::Summary summary = base::summarize(values);
    const auto check = [&](double percentile, std::size_t percent) {
      const auto at_most = [&](double bound) {
        return std::count_if(values.begin(), values.end(), [&](double v) { return v <= bound; });
      };
      const auto below = [&](double bound) {
        return std::count_if(values.begin(), values.end(), [&](double v) { return v < bound; });
      };
      EXPECT_GE(static_cast<std::size_t>(at_most(percentile)) * 100, percent * count) << count;
      EXPECT_LT(static_cast<std::size_t>(below(percentile)) * 100, percent * count) << count;
    };
    check(summary.percentile_95, 95);
    check(summary.percentile_99, 99);
  }
}

}  // namespace
}  // namespace tenebra
