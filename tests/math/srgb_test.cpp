// The sRGB curve by IEC 61966-2-1.
#include "math/srgb.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tenebra::math {
namespace {

// Both formulas of the standard, written out in long double; the standard rounds its constants, so that its
// two halves meet within 1e-7 only and its two directions are inverses within as much.
TEST(Srgb, IsTheStandardsCurve) {
  for (int i = 0; i <= 100000; ++i) {
    const long double x = i / 100000.0L;
    const long double linear = x <= 0.04045L ? x / 12.92L : std::pow((x + 0.055L) / 1.055L, 2.4L);
    const long double encoded = x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
    const auto rounded = static_cast<double>(x);
    EXPECT_NEAR(linear_of_srgb(rounded), static_cast<double>(linear), 1e-15) << i;
    EXPECT_NEAR(srgb_of_linear(rounded), static_cast<double>(encoded), 2e-15) << i;
    EXPECT_NEAR(linear_of_srgb(static_cast<float>(x)), static_cast<double>(linear), 3e-7) << i;
    EXPECT_NEAR(srgb_of_linear(static_cast<float>(x)), static_cast<double>(encoded), 5e-7) << i;
    EXPECT_NEAR(srgb_of_linear(linear_of_srgb(rounded)), rounded, 1e-7) << i;
  }
}

// Levels that the standard's readers agree on: 0 and 1 stay, 188 of 255 is half the light.
TEST(Srgb, KnownLevels) {
  EXPECT_EQ(linear_of_srgb(0.0), 0.0);
  EXPECT_EQ(linear_of_srgb(1.0), 1.0);
  EXPECT_EQ(srgb_of_linear(0.0), 0.0);
  EXPECT_NEAR(srgb_of_linear(1.0), 1.0, 1e-15);
  EXPECT_EQ(std::lround(255 * srgb_of_linear(0.5)), 188);
  EXPECT_EQ(std::lround(255 * srgb_of_linear(0.18)), 118);
  EXPECT_NEAR(linear_of_srgb(0.04045), 0.0031308, 1e-7);  // where the halves meet
}

}  // namespace
}  // namespace tenebra::math
