// g++ 12.2 with its SLP vectoriser drops the rounding of these paired splits; the build switches it off.
#include <gtest/gtest.h>

namespace {

// Not inlined and not constant: what matters is the code generated for it.
__attribute__((noinline)) void split_two(double x, double y, float* rest) {
  const float h = static_cast<float>(x), g = static_cast<float>(y);
  rest[0] = static_cast<float>(x - static_cast<double>(h));
  rest[1] = static_cast<float>(y - static_cast<double>(g));
}

TEST(FloatSplit, KeepsTheRestOfEachRounding) {
  float rest[2];
  split_two(1.0 + 0x1p-30, 3.0 - 0x1p-29, rest);
  EXPECT_EQ(rest[0], 0x1p-30f);
  EXPECT_EQ(rest[1], -0x1p-29f);
}

}  // namespace
