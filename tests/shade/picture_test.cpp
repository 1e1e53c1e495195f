// Pictures: levels rounded right, and sums over lights, masks, irradiance and openness.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "shade/encoder.h"
#include "shade/shading.h"
#include "support/hand_made.h"

namespace tenebra {
namespace {

/// Before rounding to a level: 0 .. 255.
double level_of(double linear, Transfer transfer = Transfer::srgb) {
  const double x = std::clamp(linear, 0.0, 1.0);
  if (transfer == Transfer::display) return 255.0 * x;
  return 255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

/// A picture of one empty pixel in this colour.
glm::ivec3 encoded(glm::vec3 linear, float exposure = 1.0f, Transfer transfer = Transfer::srgb) {
  const std::vector<std::uint32_t> ids{background_id};
  const shade::SurfaceTable surfaces;
  io::Image8 image;
  shade::shade_picture({{}, {}, surfaces}, {.background = linear}, {1, 1, ids, {}, {}},
                       {.exposure = exposure, .transfer = transfer}, image);
  return {image.pixels.at(0), image.pixels.at(1), image.pixels.at(2)};
}

TEST(Encoder, EveryFloatIsRoundedToItsLevel) {
  for (const Transfer transfer : {Transfer::srgb, Transfer::display}) {
    const shade::LevelTable& table = shade::level_table(transfer);
    int last = 0, reached = 1;
    for (std::uint32_t bits = 0x30000000; bits <= 0x3f800000; bits += 61) {
      const float x = std::bit_cast<float>(bits);
      const int level = shade::encode(table, x);
      EXPECT_GE(level, last);
      EXPECT_LE(std::abs(level - level_of(x, transfer)), 0.5 + 1e-9) << x;
      reached += level != last;
      last = level;
    }
    EXPECT_EQ(reached, 256);
    EXPECT_EQ(shade::encode(table, 0.0f), 0);
    EXPECT_EQ(shade::encode(table, -1.0f), 0);
    EXPECT_EQ(shade::encode(table, std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(shade::encode(table, 1e30f), 255);
  }
}

TEST(Picture, RandomColoursAreRoundedRight) {
  std::mt19937 random(21);
  for (int i = 0; i < 1000; ++i) {
    const auto value = [&] { return std::pow(static_cast<float>(random()) / 4294967296.0f, 3.0f) * 1.1f; };
    const glm::vec3 linear(value(), value(), value());
    for (const Transfer transfer : {Transfer::srgb, Transfer::display}) {
      const glm::ivec3 found = encoded(linear, 1.0f, transfer);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], level_of(linear[c], transfer), 0.5 + 1e-9) << linear[c];
    }
  }
}

TEST(Picture, ExposureScalesAndTheResultIsClamped) {
  EXPECT_EQ(encoded({0.25f, 8.0f, -1.0f}, 2.0f), glm::ivec3(std::lround(level_of(0.5)), 255, 0));
  EXPECT_EQ(encoded({0.0f, 1e38f, std::numeric_limits<float>::infinity()}, 1e3f), glm::ivec3(0, 255, 255));
}

/// The left half of a picture sees a triangle of material 1, the right half background.
class HalfPicture : public ::testing::Test {
protected:
  HalfPicture() {
    add_triangle(geometry, {0, -90, -5}, {0, 90, -5}, {-90, 0, -5}, 1);
    for (int i = 0; i < width * height; ++i) ids.push_back(is_seen(i) ? 0 : background_id);
  }
  static bool is_seen(int pixel) { return pixel % width < width / 2; }

  io::Image8 picture(const shade::Lighting& lighting, std::span<const shade::LightFactors> factors,
                     std::span<const float> openness = {}, float exposure = 1.0f) const {
    const shade::SurfaceTable surfaces(std::vector<Material>{Material{}, material});
    io::Image8 image;
    shade::shade_picture({geometry, view, surfaces}, lighting, {width, height, ids, factors, openness},
                         {.exposure = exposure}, image);
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    EXPECT_EQ(image.channels, 3);
    return image;
  }

  static constexpr int width = 150, height = 11;  // rows of two blocks and a bit
  FrameGeometry geometry;
  ViewRays view = forward_view({0, 0, 0}, 80.0f, width, height);
  std::vector<std::uint32_t> ids;
  Material material = make_material({0.5f, 0.25f, 0.125f}, {0.1f, 0.2f, 0.3f}, {0.01f, 0, 0.02f});
};

TEST_F(HalfPicture, SumsAmbientEmissiveAndLightsThroughTheirMasks) {
  std::vector<shade::DrawnLight> lights;
  const float intensities[3] = {0.5f, 0.25f, 1.0f};
  for (const float intensity : intensities)
    lights.push_back({make_light(LightType::directional, intensity, Falloff::none), {}});
  std::vector<std::vector<std::uint8_t>> masks(2, std::vector<std::uint8_t>(ids.size()));
  for (std::size_t i = 0; i < masks[0].size(); ++i) {
    masks[0][i] = i % 200 < 120 && i % 2 != 0 ? 255 : 0;
    masks[1][i] = static_cast<std::uint8_t>(11 * i);  // soft masks are fractions
  }
  const std::vector<shade::LightFactors> factors{{.mask = masks[0]}, {.mask = masks[1]}, {}};
  const shade::Lighting lighting{lights, {0.5f, 1.0f, 0.25f}, {0.9f, 0.0f, 0.4f}};
  const io::Image8 image = picture(lighting, factors, {}, 0.75f);
  for (int i = 0; i < width * height; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double lit =
        intensities[0] * masks[0][at] / 255.0 + intensities[1] * masks[1][at] / 255.0 + intensities[2];
    for (int c = 0; c < 3; ++c) {
      double linear = lighting.background[c];
      if (is_seen(i)) {
        linear = double(material.ambient[c]) * lighting.ambient_light[c] + material.emissive[c] +
                 lit * material.base_color[c];
      }
      EXPECT_NEAR(image.pixels[3 * at + static_cast<std::size_t>(c)], level_of(linear * 0.75), 0.501) << i;
    }
  }
}

TEST_F(HalfPicture, AreaLightsCountByTheirIrradianceAndOpennessByTheAmbientTermOnly) {
  std::vector<float> irradiance(ids.size()), openness(ids.size());
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    irradiance[i] = 0.13f * static_cast<float>(i % 24);  // 0 to 3, not cut at 1
    openness[i] = 1.0f - 0.04f * static_cast<float>(i % 25);
  }
  const auto polygon = make_rectangle_light({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0});
  ASSERT_TRUE(polygon);
  const std::vector<shade::DrawnLight> lights{{make_light(LightType::area_rect, 2.0f), {}, *polygon},
                                              {make_light(LightType::directional, 0.25f, Falloff::none), {}}};
  const std::vector<shade::LightFactors> factors{{.irradiance = irradiance}, {}};
  const shade::Lighting lighting{lights, {0.5f, 1.0f, 0.25f}, {0.9f, 0.0f, 0.4f}};
  for (const bool open : {true, false}) {
    const io::Image8 image =
        picture(lighting, factors, open ? std::span<const float>() : std::span<const float>(openness));
    for (int i = 0; i < width * height; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double lit = 2.0 / std::acos(-1.0) * irradiance[at] + 0.25;
      for (int c = 0; c < 3; ++c) {
        double linear = lighting.background[c];
        if (is_seen(i)) {
          linear = double(material.ambient[c]) * lighting.ambient_light[c] * (open ? 1.0 : openness[at]) +
                   material.emissive[c] + lit * material.base_color[c];
        }
        EXPECT_NEAR(image.pixels[3 * at + static_cast<std::size_t>(c)], level_of(linear), 0.501) << i;
      }
    }
  }
}

TEST_F(HalfPicture, NegativeAmbientMeansTheBaseColour) {
  material = make_material({0.5f, 0.25f, 0.125f});
  const io::Image8 image = picture({}, {});
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(image.pixels[c], std::lround(level_of(material.base_color[static_cast<int>(c)])));
  }
}

// Samples in any order and number are those of the picture: their places say where they are.
TEST_F(HalfPicture, SamplesHaveTheColoursOfTheirPixels) {
  const Light lamp = make_light(LightType::point, 40.0f);
  const std::vector<shade::DrawnLight> lights{{lamp, {.position = {-3, 1, -2}}}};
  std::vector<float> openness(ids.size());
  for (std::size_t i = 0; i < openness.size(); ++i) openness[i] = static_cast<float>(i % 7) / 7.0f;
  const shade::Lighting lighting{lights, {0.5f, 1.0f, 0.25f}, {0.9f, 0.0f, 0.4f}};
  const std::vector<shade::LightFactors> all_lit(1);
  const io::Image8 image = picture(lighting, all_lit, openness);
  std::vector<std::size_t> order(ids.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  std::vector<std::uint32_t> sample_ids;
  std::vector<glm::vec2> places;
  std::vector<float> sample_openness;
  for (const std::size_t i : order) {
    sample_ids.push_back(ids[i]);
    places.emplace_back(static_cast<float>(i % width) + 0.5f, static_cast<float>(i / width) + 0.5f);
    sample_openness.push_back(openness[i]);
  }
  const shade::SurfaceTable surfaces(std::vector<Material>{Material{}, material});
  std::vector<shade::ShadedSample> shaded;
  shade::shade_samples({geometry, view, surfaces}, lighting, {sample_ids, places, all_lit, sample_openness},
                       shaded);
  ASSERT_EQ(shaded.size(), order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(image.pixels[3 * order[k] + c], level_of(shaded[k].color[static_cast<int>(c)]), 0.51);
    }
  }
}

}  // namespace
}  // namespace tenebra
