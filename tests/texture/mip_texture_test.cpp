// Smaller copies of pictures, and what a pixel sees of them.
#include "texture/mip_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/sample_one.h"
#include "texture/bilinear.h"

namespace tenebra::texture {
namespace {

TextureImage image_of(int width, int height, auto value) {
  TextureImage image{"made", width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::ivec4 v = value(x, y);
      for (int c = 0; c < 4; ++c) image.rgba.push_back(static_cast<std::uint8_t>(v[c]));
    }
  }
  return image;
}

TextureImage noise(int width, int height, unsigned seed, bool opaque = true) {
  std::mt19937 random(seed);
  return image_of(width, height, [&](int, int) {
    glm::ivec4 v;
    for (int c = 0; c < 4; ++c) v[c] = static_cast<int>(random() >> 24);
    if (opaque) v.a = 255;
    return v;
  });
}

MipTexture made(const TextureImage& image, Content content) {
  return {image, content, Wrap::repeat, Wrap::repeat};
}

constexpr Footprint enlarged{{1e-4f, 0}, {0, 1e-4f}};

constexpr double step = 1 / 65535.0;  // between values that are kept

TEST(MipTexture, MeansOfDirectionsAreUnitAgain) {
  // Half of it leans to the right, half to the left: the mean of these is short, what is kept is not.
  const TextureImage lean = image_of(4, 4, [](int x, int) {
    return x % 2 ? glm::ivec4(230, 128, 204, 255) : glm::ivec4(77, 128, 204, 255);
  });
  const MipTexture made_of_normals = made(lean, Content::normal), of_data = made(lean, Content::data);
  EXPECT_EQ(made_of_normals.pixel(0, 1, 0), of_data.pixel(0, 1, 0));
  for (int level = 1; level < 3; ++level) {
    const glm::vec3 mean = 2.0f * glm::vec3(of_data.pixel(level, 0, 0)) - 1.0f,
                    kept = 2.0f * glm::vec3(made_of_normals.pixel(level, 0, 0)) - 1.0f;
    EXPECT_LT(glm::length(mean), 0.7f);
    EXPECT_NEAR(glm::length(kept - glm::normalize(mean)), 0, 4 * step);
  }
}

TEST(MipTexture, LevelsAreMeansOfLight) {
  const TextureImage checker =
      image_of(8, 8, [](int x, int y) { return (x + y) % 2 ? glm::ivec4(255) : glm::ivec4(0, 0, 0, 255); });
  const TextureImage greys =
      image_of(8, 8, [](int x, int y) { return (x + y) % 2 ? glm::ivec4(188) : glm::ivec4(0, 0, 0, 255); });
  const MipTexture light = made(checker, Content::srgb_color),
                   display = made(checker, Content::display_color),
                   grey = made(greys, Content::srgb_beside_data);
  ASSERT_EQ(light.level_count(), 4);
  for (int level = 1; level < 4; ++level) {
    EXPECT_NEAR(light.pixel(level, 0, 0).x, 0.5, 0.51 * step);
    EXPECT_NEAR(display.pixel(level, 0, 0).x, 0.5, 0.51 * step);
    // 188 of 255 is the level of half the light; a mean of levels would be 94, of 0.11.
    EXPECT_NEAR(grey.pixel(level, 0, 0).x, 0.5 * std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 0.51 * step);
  }
}

TEST(MipTexture, TheLastLevelOfAnySizeIsTheMeanOfAll) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 1}, {5, 7}, {64, 3}, {13, 100}}) {
    const TextureImage image = noise(width, height, 3);
    const MipTexture texture = made(image, Content::display_color);
    double sum = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    const int last = texture.level_count() - 1;
    EXPECT_EQ(texture.width(last), 1);
    EXPECT_EQ(texture.height(last), 1);
    EXPECT_NEAR(texture.pixel(last, 0, 0).x, sum / (255.0 * width * height), 0.6 * step) << width << height;
  }
}

TEST(MipTexture, WhatIsSeeThroughDoesNotShineThrough) {
  const TextureImage leaf = image_of(
      4, 4, [](int x, int) { return x % 2 ? glm::ivec4(0, 200, 0, 255) : glm::ivec4(255, 255, 255, 0); });
  const glm::vec4 mean = made(leaf, Content::display_color).pixel(2, 0, 0);
  EXPECT_NEAR(mean.g, 200 / 255.0, 1e-6);
  EXPECT_EQ(mean.r, 0);
  EXPECT_NEAR(mean.a, 0.5, 0.51 * step);
}

TEST(MipTexture, EnlargedItIsTheBilinearOne) {
  std::mt19937 random(8);
  const auto uniform = [&] { return static_cast<float>(random()) / 4294967296.0f; };
  const TextureImage image = noise(7, 12, 4, false);
  for (const Wrap wrap_u : {Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat}) {
    for (const Wrap wrap_v : {Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat}) {
      const MipTexture texture(image, Content::data, wrap_u, wrap_v);
      TextureMap map{.image = 0, .wrap_u = wrap_u, .wrap_v = wrap_v};
      map.transform = {1.5f, 0.25f, -0.5f, 2.0f, 0.125f, -3.0f};
      for (int i = 0; i < 500; ++i) {
        const glm::vec2 uv(9 * uniform() - 4, 9 * uniform() - 4);
        const glm::vec4 found = sample_one(texture, map, uv, enlarged),
                        expected = sample_bilinear(image, map, uv);
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(found[c], expected[c], 3e-6) << uv.x << " " << uv.y;
      }
    }
  }
}

TEST(MipTexture, FiltersChooseLevelsAndPixels) {
  const TextureImage image = noise(16, 16, 6);
  const MipTexture texture = made(image, Content::data);
  TextureMap map{.image = 0, .magnify = Filter::nearest, .minify = Filter::nearest};
  const glm::vec2 uv(0.4f, 0.7f);  // pixel (6, 11)
  EXPECT_EQ(sample_one(texture, map, uv, enlarged), texture.pixel(0, 6, 11));
  const Footprint four{{4 / 16.0f, 0}, {0, 4 / 16.0f}};  // four pixels wide: level 2
  map.mip = MipFilter::none;
  EXPECT_EQ(sample_one(texture, map, uv, four), texture.pixel(0, 6, 11));
  for (const MipFilter mip : {MipFilter::nearest, MipFilter::linear}) {
    map.mip = mip;
    EXPECT_EQ(sample_one(texture, map, uv, four), texture.pixel(2, 1, 2));
  }
  const Footprint between{{4 * std::numbers::sqrt2_v<float> / 16, 0},
                          {0, 4 * std::numbers::sqrt2_v<float> / 16}};
  const glm::vec4 mixed = sample_one(texture, map, uv, between);
  const glm::vec4 expected = 0.5f * (texture.pixel(2, 1, 2) + texture.pixel(3, 0, 1));
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(mixed[c], expected[c], 1e-5);
}

// Stripes run along u; a footprint that is long in v, across them, averages them, and one that is long in u
// keeps them: by the shorter axis alone it would alias, by the longer alone it would blur.
TEST(MipTexture, LongFootprintsKeepWhatTheirShortAxisCanSee) {
  const TextureImage stripes =
      image_of(64, 64, [](int, int y) { return y % 16 < 8 ? glm::ivec4(255) : glm::ivec4(0, 0, 0, 255); });
  const MipTexture texture = made(stripes, Content::data);
  const TextureMap map{.image = 0};
  const glm::vec2 uv(0.5f, 4 / 64.0f);  // the middle of a bright stripe
  for (const float turn : {1.0f, -1.0f}) {
    const Footprint along{{turn * 16 / 64.0f, 0}, {0, 1 / 64.0f}},
        across{{0, turn * 16 / 64.0f}, {1 / 64.0f, 0}};
    EXPECT_GT(sample_one(texture, map, uv, along).x, 0.99);
    EXPECT_NEAR(sample_one(texture, map, uv, across).x, 0.5, 0.05);
  }
  const Footprint round{{16 / 64.0f, 0}, {0, 16 / 64.0f}};
  EXPECT_NEAR(sample_one(texture, map, uv, round).x, 0.5, 0.01);
}

// The same ellipse from two other vectors that span it: pixels that are turned against the texture.
TEST(MipTexture, FootprintsAreEllipsesAndNotTheirVectors) {
  const MipTexture texture = made(noise(128, 128, 9), Content::srgb_color);
  const TextureMap map{.image = 0};
  const glm::vec2 uv(0.3f, 0.6f), major = glm::vec2(6, 3) / 128.0f, minor = glm::vec2(-1, 2) / 128.0f;
  const glm::vec4 straight = sample_one(texture, map, uv, {major, minor});
  const float c = std::cos(0.7f), s = std::sin(0.7f);
  const glm::vec4 turned = sample_one(texture, map, uv, {c * major + s * minor, c * minor - s * major});
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(straight[k], turned[k], 1e-4);
}

TEST(MipTexture, AnyCoordinateAndFootprintIsAnswered) {
  const float infinity = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  const float values[] = {0.0f, 1.0f, -1.0f, 1e-30f, 1e6f, -1e12f, 1e30f, infinity, -infinity, nan};
  for (const Wrap wrap : {Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat}) {
    const TextureMap map{.image = 0, .wrap_u = wrap, .wrap_v = wrap};
    const MipTexture texture(noise(5, 3, 2), Content::srgb_color, wrap, wrap);
    for (const float u : values) {
      for (const float change : values) {
        const glm::vec4 found = sample_one(texture, map, {u, 0.5f}, {{change, 0}, {u, change}});
        for (int c = 0; c < 4; ++c) EXPECT_TRUE(found[c] >= 0 && found[c] <= 1) << u << " " << change;
      }
    }
  }
}

}  // namespace
}  // namespace tenebra::texture
