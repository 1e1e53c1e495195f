// The picture: sRGB to the level, sums over lights and masks, and whole frames alike on both kinds of
// context.
#include "raster/composite.h"

#include <numeric>

#include "raster/raster_fixture.h"

namespace tenebra {
namespace {

/// sRGB in double, before rounding to a level: 0 .. 255.
double srgb_level(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return 255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}
double linear_of_level(double level) {
  const double y = level / 255.0;
  return y <= 0.04045 ? y / 12.92 : std::pow((y + 0.055) / 1.055, 2.4);
}

class CompositeTest : public RasterTest {
protected:
  /// A picture of one empty pixel in this colour.
  glm::ivec3 encode(glm::vec3 linear, float exposure = 1.0f) {
    base::Image8 image;
    EXPECT_TRUE(passes().compositor.begin(1, 1));
    passes().compositor.finish(passes().gbuffer, passes().geometry,
                               {.background = linear, .exposure = exposure}, image);
    return {image.pixels.at(0), image.pixels.at(1), image.pixels.at(2)};
  }
};

TEST_P(CompositeTest, EveryLevelOfSrgbIsReachedAndRoundedRight) {
  draw({}, forward_view({0, 0, 0}, 9.0f, 1, 1), 1, 1, {});
  constexpr double slack = 1e-3;  // of a level, around the ties
  for (int level = 0; level <= 255; ++level) {
    const glm::vec3 linear(linear_of_level(level), linear_of_level(std::max(level - 0.5 + slack, 0.0)),
                           linear_of_level(level + 0.5 - slack));
    EXPECT_EQ(encode(linear), glm::ivec3(level)) << level;
  }
}

TEST_P(CompositeTest, RandomColoursAreRoundedRight) {
  draw({}, forward_view({0, 0, 0}, 9.0f, 1, 1), 1, 1, {});
  std::mt19937 random(21);
  for (int i = 0; i < 1000; ++i) {
    const auto value = [&] { return std::pow(static_cast<float>(random()) / 4294967296.0f, 3.0f) * 1.1f; };
    const glm::vec3 linear(value(), value(), value());
    const glm::ivec3 found = encode(linear);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], srgb_level(linear[c]), 0.501) << linear[c];
  }
}

TEST_P(CompositeTest, ExposureScalesAndTheResultIsClamped) {
  draw({}, forward_view({0, 0, 0}, 9.0f, 1, 1), 1, 1, {});
  EXPECT_EQ(encode({0.25f, 8.0f, -1.0f}, 2.0f), glm::ivec3(std::lround(srgb_level(0.5)), 255, 0));
  EXPECT_EQ(encode({0.0f, 1e38f, std::numeric_limits<float>::infinity()}, 1e3f), glm::ivec3(0, 255, 255));
}

/// Left half of the picture a triangle of material 1, right half background.
FrameGeometry left_half() {
  FrameGeometry g;
  add_triangle(g, {0, -90, -5}, {0, 90, -5}, {-90, 0, -5}, 1);
  return g;
}

TEST_P(CompositeTest, SumsAmbientEmissiveAndLightsThroughTheirMasks) {
  constexpr int width = 6, height = 4;
  const Material material = make_material({0.5f, 0.25f, 0.125f}, {0.1f, 0.2f, 0.3f}, {0.01f, 0, 0.02f});
  draw(left_half(), forward_view({0, 0, 0}, 10.0f, width, height), width, height, {Material{}, material});
  const raster::CompositeSettings settings{
      .ambient_light = {0.5f, 1.0f, 0.25f}, .background = {0.9f, 0.0f, 0.4f}, .exposure = 0.75f};
  const float intensities[3] = {0.5f, 0.25f, 1.0f};
  std::vector<std::vector<std::uint8_t>> masks(3, std::vector<std::uint8_t>(width * height));
  for (std::size_t i = 0; i < masks[0].size(); ++i) {
    masks[0][i] = i % 2 ? 255 : 0;
    masks[1][i] = static_cast<std::uint8_t>(11 * i);  // soft masks are fractions
  }
  masks[2].clear();  // lit everywhere
  ASSERT_TRUE(passes().compositor.begin(width, height));
  for (std::size_t l = 0; l < 3; ++l) {
    const Light light = make_light(LightType::directional, intensities[l], Falloff::none);
    ASSERT_TRUE(
        passes().light_pass.draw(passes().gbuffer, passes().geometry, light, {}, passes().light_buffer));
    passes().compositor.add_light(passes().light_buffer, masks[l]);
  }
  base::Image8 image;
  passes().compositor.finish(passes().gbuffer, passes().geometry, settings, image);
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  ASSERT_EQ(image.channels, 3);
  for (int i = 0; i < width * height; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double lit =
        intensities[0] * masks[0][at] / 255.0 + intensities[1] * masks[1][at] / 255.0 + intensities[2];
    for (int c = 0; c < 3; ++c) {
      double linear = settings.background[c];
      if (i % width < width / 2) {
        linear = double(material.ambient[c]) * settings.ambient_light[c] + material.emissive[c] +
                 lit * material.base_color[c];
      }
      EXPECT_NEAR(image.pixels[3 * at + static_cast<std::size_t>(c)], srgb_level(linear * settings.exposure),
                  0.501)
          << i;
    }
  }
}

TEST_P(CompositeTest, AreaLightsCountByTheirIrradianceAndOpennessByTheAmbientTermOnly) {
  constexpr int width = 6, height = 4;
  const Material material = make_material({0.5f, 0.25f, 0.125f}, {0.1f, 0.2f, 0.3f}, {0.01f, 0, 0.02f});
  draw(left_half(), forward_view({0, 0, 0}, 10.0f, width, height), width, height, {Material{}, material});
  std::vector<float> irradiance(width * height), openness(width * height);
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    irradiance[i] = 0.13f * static_cast<float>(i);  // 0 to 3, not cut at 1
    openness[i] = 1.0f - 0.04f * static_cast<float>(i);
  }
  const Light area = make_light(LightType::area_rect, 2.0f);
  const Light sun = make_light(LightType::directional, 0.25f, Falloff::none);
  const raster::CompositeSettings open{.ambient_light = {0.5f, 1.0f, 0.25f},
                                       .background = {0.9f, 0.0f, 0.4f}};
  raster::CompositeSettings closing = open;
  closing.openness = openness;
  for (const raster::CompositeSettings& settings : {open, closing}) {
    ASSERT_TRUE(passes().compositor.begin(width, height));
    ASSERT_TRUE(passes().light_pass.draw_area(passes().gbuffer, passes().geometry, area, {}, 1.0,
                                              passes().light_buffer));
    passes().compositor.add_area_light(passes().light_buffer, irradiance);
    ASSERT_TRUE(
        passes().light_pass.draw(passes().gbuffer, passes().geometry, sun, {}, passes().light_buffer));
    passes().compositor.add_light(passes().light_buffer, {});  // no factor of the light before
    base::Image8 image;
    passes().compositor.finish(passes().gbuffer, passes().geometry, settings, image);
    for (int i = 0; i < width * height; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double lit = 2.0 / std::acos(-1.0) * irradiance[at] + 0.25;
      const double let_through = settings.openness.empty() ? 1.0 : openness[at];
      for (int c = 0; c < 3; ++c) {
        double linear = settings.background[c];
        if (i % width < width / 2) {
          linear = double(material.ambient[c]) * settings.ambient_light[c] * let_through +
                   material.emissive[c] + lit * material.base_color[c];
        }
        EXPECT_NEAR(image.pixels[3 * at + static_cast<std::size_t>(c)], srgb_level(linear), 0.501) << i;
      }
    }
  }
}

TEST_P(CompositeTest, NegativeAmbientMeansTheBaseColour) {
  const Material material = make_material({0.5f, 0.25f, 0.125f});
  draw(left_half(), forward_view({0, 0, 0}, 10.0f, 2, 1), 2, 1, {Material{}, material});
  base::Image8 image;
  ASSERT_TRUE(passes().compositor.begin(2, 1));
  passes().compositor.finish(passes().gbuffer, passes().geometry, {}, image);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(image.pixels[c], std::lround(srgb_level(material.base_color[static_cast<int>(c)])));
  }
}

TEST_P(CompositeTest, ALightsSumDoesNotLeakIntoTheNextFrame) {
  draw(left_half(), forward_view({0, 0, 0}, 10.0f, 4, 3), 4, 3, {Material{}, Material{}});
  const Light light = make_light(LightType::directional, 0.3f, Falloff::none);
  base::Image8 frames[2];
  for (base::Image8& frame : frames) {
    ASSERT_TRUE(passes().compositor.begin(4, 3));
    ASSERT_TRUE(
        passes().light_pass.draw(passes().gbuffer, passes().geometry, light, {}, passes().light_buffer));
    passes().compositor.add_light(passes().light_buffer, {});
    passes().compositor.finish(passes().gbuffer, passes().geometry, {.ambient_light = glm::vec3(0.1f)},
                               frame);
  }
  EXPECT_EQ(frames[0], frames[1]);
}

/// All that one frame leaves behind.
struct Frame {
  std::vector<std::uint32_t> ids;
  std::vector<float> depth;
  base::ImageF light;
  base::Image8 picture;
};

Frame draw_frame(gl::ContextKind kind) {
  Frame frame;
  auto context = gl::Context::create(kind);
  EXPECT_TRUE(context);
  auto gbuffer_pass = raster::GBufferPass::create();
  auto light_pass = raster::LightPass::create();
  auto compositor = raster::Compositor::create();
  raster::GeometryBuffers geometry;
  raster::GBuffer gbuffer;
  raster::LightBuffer light_buffer;
  const std::vector<Material> materials(1);
  EXPECT_TRUE(geometry.upload_materials(materials) && geometry.upload(random_soup(25, {0, 0, -9}, 3.0f, 99)));
  EXPECT_TRUE(gbuffer_pass->draw(forward_view({0, 0, 0}, 200.0f, 257, 191), geometry, 257, 191, gbuffer));
  raster::read_triangle_ids(gbuffer, frame.ids);
  raster::read_depth(gbuffer, frame.depth);
  std::vector<std::uint8_t> mask(frame.ids.size());
  std::iota(mask.begin(), mask.end(), std::uint8_t{0});
  Light light = make_light(LightType::spot, 300.0f);
  light.range_m = 30.0f;
  EXPECT_TRUE(compositor->begin(257, 191));
  EXPECT_TRUE(light_pass->draw(gbuffer, geometry, light, {.position = {1, 1, 2}}, light_buffer));
  raster::read_light_buffer(light_buffer, frame.light);
  compositor->add_light(light_buffer, mask);
  compositor->finish(gbuffer, geometry, {.ambient_light = glm::vec3(0.1f)}, frame.picture);
  return frame;
}

TEST(Raster, SameBitsFromEglAndOsmesa) {
  TENEBRA_NEEDS_CONTEXT(gl::ContextKind::osmesa);
  const Frame egl = draw_frame(gl::ContextKind::egl), osmesa = draw_frame(gl::ContextKind::osmesa);
  EXPECT_EQ(egl.ids, osmesa.ids);
  EXPECT_EQ(egl.depth, osmesa.depth);
  EXPECT_EQ(egl.light, osmesa.light);
  EXPECT_EQ(egl.picture, osmesa.picture);
  // A frame worth comparing: background, triangles, light.
  EXPECT_GT(std::count(egl.ids.begin(), egl.ids.end(), background_id), 100);
  EXPECT_GT(std::count_if(egl.light.pixels.begin(), egl.light.pixels.end(), [](float v) { return v > 0; }),
            1000);
}

TENEBRA_BOTH_CONTEXTS(CompositeTest);

}  // namespace
}  // namespace tenebra
