#include "texture/bilinear.h"

#include <gtest/gtest.h>

#include <limits>

namespace tenebra::texture {
namespace {

/// 2x2: reds 0, 255 above 51, 102.
TextureImage small_image() {
  return {"small", 2, 2, {0, 0, 0, 255, 255, 0, 0, 255, 51, 0, 0, 255, 102, 0, 0, 0}};
}

float red(glm::vec2 uv, const TextureMap& map = {}) {
  return sample_bilinear(small_image(), map, uv).r * 255.0f;
}

TEST(Bilinear, PixelCentresAreThePixels) {
  EXPECT_FLOAT_EQ(red({0.25f, 0.25f}), 0.0f);
  EXPECT_FLOAT_EQ(red({0.75f, 0.25f}), 255.0f);
  EXPECT_FLOAT_EQ(red({0.25f, 0.75f}), 51.0f);
  EXPECT_FLOAT_EQ(red({0.75f, 0.75f}), 102.0f);
}

TEST(Bilinear, MiddleIsTheMeanOfFour) {
  EXPECT_FLOAT_EQ(red({0.5f, 0.5f}), 102.0f);
  EXPECT_FLOAT_EQ(sample_bilinear(small_image(), {}, {0.5f, 0.5f}).a, 0.75f);
}

TEST(Bilinear, WrapsEachWay) {
  TextureMap map;
  EXPECT_FLOAT_EQ(red({1.25f, 0.25f}, map), 0.0f);
  EXPECT_FLOAT_EQ(red({-0.25f, -2.75f}, map), 255.0f);
  EXPECT_FLOAT_EQ(red({0.0f, 0.25f}, map), 127.5f);  // between the last column and the first
  map.wrap_u = Wrap::clamp_to_edge;
  EXPECT_FLOAT_EQ(red({-7.0f, 0.25f}, map), 0.0f);
  EXPECT_FLOAT_EQ(red({7.0f, 0.25f}, map), 255.0f);
  map.wrap_u = Wrap::mirrored_repeat;
  EXPECT_FLOAT_EQ(red({1.25f, 0.25f}, map), 255.0f);
  EXPECT_FLOAT_EQ(red({-0.25f, 0.25f}, map), 0.0f);
  EXPECT_FLOAT_EQ(red({2.25f, 0.25f}, map), 0.0f);
}

TEST(Bilinear, TransformComesFirst) {
  TextureMap map;
  map.transform = glm::mat3x2(2, 0, 0, 1, 0.25f, 0);
  EXPECT_FLOAT_EQ(red({0.25f, 0.25f}, map), 255.0f);
}

TEST(Bilinear, NoNumberIsTheFirstPixel) {
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_FLOAT_EQ(red({infinite, 0.25f}), 0.0f);
  EXPECT_FLOAT_EQ(red({std::numeric_limits<float>::quiet_NaN(), 0.25f}), 0.0f);
  EXPECT_FLOAT_EQ(red({1e30f, -1e30f}), 0.0f);
}

}  // namespace
}  // namespace tenebra::texture
