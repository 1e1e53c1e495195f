#include "log/ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tenebra::viewer {
namespace {

using Numbers = std::vector<double>;

TEST(Ticks, AreRoundNumbersAsManyAsAskedFor) {
  EXPECT_EQ(tick_step(100, 10), 10);
  EXPECT_EQ(tick_step(101, 10), 20);
  EXPECT_EQ(tick_step(7, 10), 1);
  EXPECT_EQ(tick_step(0.35, 5), 0.1);
  EXPECT_GT(tick_step(0, 5), 0);
  EXPECT_EQ(even_ticks(-0.5, 2.5, 1), (Numbers{0, 1, 2}));
  EXPECT_EQ(even_ticks(3, 20, 5), (Numbers{5, 10, 15, 20}));
  EXPECT_FALSE(std::signbit(even_ticks(-0.5, 2.5, 1).front())) << "-0 would be printed with its sign";
}

TEST(Ticks, OfALogarithmicAxisAreOneTwoAndFiveInEachDecade) {
  EXPECT_EQ(logarithmic_ticks(0.9, 30), (Numbers{1, 2, 5, 10, 20}));
  EXPECT_EQ(logarithmic_ticks(100, 100), (Numbers{100}));
  EXPECT_EQ(logarithmic_ticks(6, 9), Numbers());
  EXPECT_EQ(logarithmic_ticks(HUGE_VAL, HUGE_VAL), Numbers()) << "a plot without points";
  EXPECT_EQ(logarithmic_ticks(0, 10), Numbers());
}

}  // namespace
}  // namespace tenebra::viewer
