// Several samples per pixel: which pixels get them, what their means are, and what stays as it is with one.
#include "render/antialias/pattern.h"
#include "render/antialias/surface_match.h"
#include "render/render_fixture.h"

namespace tenebra {
namespace {

using glm::vec3;
using render::FrameResult;
using render::RenderSettings;

constexpr int width = 120, height = 90;

render::Renderer cpu_renderer(const Scene& scene) {
  auto raster = render::FrameRaster::create({.kind = render::RasterKind::cpu});
  EXPECT_TRUE(raster) << raster.error().message;
  return render::Renderer::create(std::move(*raster), scene);
}

FrameResult draw_view(const Scene& scene, const RenderSettings& settings, const render::FrameInput& input) {
  render::Renderer renderer = cpu_renderer(scene);
  FrameResult result;
  const auto drawn = renderer.render_frame(input, settings, result);
  EXPECT_TRUE(drawn) << drawn.error().message;
  return result;
}
FrameResult draw_with(const Scene& scene, const RenderSettings& settings) {
  return draw_view(scene, settings, frame_of(scene, settings.width, settings.height));
}

/// The floor and the plate, below a sun: all that is lit, and all that is not, has one colour.
Scene sunny_floor() {
  Scene scene = white_floor(true);
  scene.transfer = Transfer::display;
  scene.ambient_light = vec3(0.25f);
  add_light(scene,
            {.name = "sun", .type = LightType::directional, .falloff = Falloff::none, .intensity = 0.5f},
            {0, 0, 0}, glm::normalize(facing_down + glm::dquat(0, 0, 0.2, 0.1)));
  return scene;
}

RenderSettings settings_of(int samples, bool everywhere = false) {
  RenderSettings settings{.width = width, .height = height};
  settings.antialias = samples;
  settings.antialias_everywhere = everywhere;
  settings.mask_means = true;
  return settings;
}

TEST(SamplePattern, CoversHalfPlanesAsWellAsItSays) {
  const struct {
    int samples;
    double most;  // root of the mean square error
  } patterns[] = {{2, 0.16}, {4, 0.10}, {8, 0.055}, {16, 0.033}, {256, 0.006}};
  for (const auto& [samples, most] : patterns) {
    const render::SamplePattern pattern = render::sample_pattern(samples);
    ASSERT_EQ(pattern.count(), static_cast<std::size_t>(samples));
    std::vector<glm::vec2> places(pattern.offsets.begin(), pattern.offsets.end());
    if (pattern.centre_counts) places.emplace_back(0.0f);
    glm::vec2 mean(0.0f);
    for (const glm::vec2 place : places) {
      EXPECT_LT(std::max(std::abs(place.x), std::abs(place.y)), 0.5f);
      mean += place / static_cast<float>(samples);
    }
    EXPECT_LT(glm::length(mean), 0.01f) << samples;
    double sum = 0;
    int count = 0;
    for (int a = 0; a < 32; ++a) {
      const double angle = 3.14159265358979 * (a + 0.5) / 32;
      const glm::dvec2 normal(std::cos(angle), std::sin(angle));
      for (double at = -0.7; at < 0.7; at += 0.0175, ++count) {
        int inside = 0, covered = 0;
        for (int i = 0; i < 64 * 64; ++i)
          covered +=
              normal.x * ((i % 64 + 0.5) / 64 - 0.5) + normal.y * ((i / 64 + 0.5) / 64 - 0.5) < at ? 1 : 0;
        for (const glm::vec2 place : places) inside += glm::dot(normal, glm::dvec2(place)) < at ? 1 : 0;
        const double error = static_cast<double>(inside) / samples - covered / 4096.0;
        sum += error * error;
      }
    }
    EXPECT_LT(std::sqrt(sum / count), most) << samples;
  }
  EXPECT_FALSE(render::is_sample_count(3));
  EXPECT_FALSE(render::is_sample_count(0));
}

TEST(SurfaceMatch, KnowsWhereTrianglesBoundEachOther) {
  FrameGeometry geometry;
  // 0 and 1: a quad at z = 0; 2: a fold of 10 degrees at its right edge; 3: a fold of 60 degrees; 4: parallel
  // to the quad, 0.2 before it; 5: as 1, of another material.
  const float up = std::tan(0.1745f), steep = std::tan(1.0472f);
  geometry.positions = {{-4, -4, 0},        {4, -4, 0},     {4, 4, 0},     {-4, 4, 0},  {8, -4, 4 * up},
                        {8, -4, 4 * steep}, {-4, -4, 0.2f}, {4, -4, 0.2f}, {4, 4, 0.2f}};
  geometry.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {1, 5, 2}, {6, 7, 8}, {0, 2, 3}};
  geometry.materials = {0, 0, 0, 0, 0, 1};
  const ViewRays view = look_at({0.5f, 0.25f, 20}, {0, 0, 0}, {0, 1, 0}, 0.8f, 0.1f, 100, 100);
  render::SurfaceMatch match(geometry, view);
  const auto place_of = [&](vec3 p) {
    const glm::dvec3 d = glm::dvec3(p - view.eye);
    const glm::dmat3 axes{glm::dvec3(view.dx), glm::dvec3(view.dy), glm::dvec3(view.d0)};
    const glm::dvec3 at = glm::inverse(axes) * d;
    return glm::vec2(glm::dvec2(at) / at.z);
  };
  const glm::vec2 middle = place_of({0, 0, 0}), fold = place_of({4, 1, 0});
  const auto both = [&](std::uint32_t a, std::uint32_t b, glm::vec2 place) {
    EXPECT_EQ(match.same(a, b, place), match.same(b, a, place));
    return match.same(a, b, place);
  };
  EXPECT_TRUE(both(0, 1, middle));
  EXPECT_TRUE(both(0, 2, fold));
  EXPECT_FALSE(both(0, 2, middle)) << "their planes lie far apart there";
  EXPECT_FALSE(both(0, 3, fold));
  EXPECT_FALSE(both(0, 4, middle));
  EXPECT_FALSE(both(0, 5, middle));
  EXPECT_FALSE(both(0, no_triangle, middle));
  EXPECT_TRUE(both(no_triangle, no_triangle, middle));
}

TEST(Antialias, CentresKeepTheirMasksAndFewPixelsAreRefined) {
  const Scene scene = sunny_floor();
  const FrameResult one = draw_with(scene, settings_of(1));
  EXPECT_TRUE(one.masks[0].mean.pixels.empty());
  EXPECT_EQ(one.antialias.pixels, 0u);
  for (const int samples : {2, 4, 8, 16}) {
    const FrameResult several = draw_with(scene, settings_of(samples));
    EXPECT_EQ(several.masks[0].mask, one.masks[0].mask) << samples;
    EXPECT_GT(several.antialias.pixels, 50u);
    EXPECT_LT(several.antialias.pixels, std::uint64_t{width} * height / 4);
    EXPECT_FALSE(several.image == one.image);
  }
}

// The mean of pictures of shifted views, each with one sample per pixel: none of the stages of anti-aliasing.
TEST(Antialias, EverywhereIsTheMeanOfShiftedPictures) {
  const Scene scene = sunny_floor();
  for (const int samples : {2, 4, 16}) {
    const FrameResult whole = draw_with(scene, settings_of(samples, true));
    const render::FrameInput input = frame_of(scene, width, height);
    const render::SamplePattern pattern = render::sample_pattern(samples);
    std::vector<double> sums(3 * width * height, 0.0), lit(width * height, 0.0);
    const auto add = [&](glm::vec2 offset) {
      render::FrameInput shifted = input;
      shifted.view = render::shifted_view(input.view, offset);
      const FrameResult one = draw_view(scene, settings_of(1), shifted);
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += one.image.pixels[i];
      for (std::size_t i = 0; i < lit.size(); ++i) lit[i] += one.masks[0].mask.pixels[i] / 255.0;
    };
    for (const glm::vec2 offset : pattern.offsets) add(offset);
    if (pattern.centre_counts) add(glm::vec2(0.0f));
    int mixed = 0;
    for (std::size_t i = 0; i < sums.size(); ++i)
      EXPECT_NEAR(whole.image.pixels[i], sums[i] / samples, 1.0) << samples << ' ' << i;  // display values
    for (std::size_t i = 0; i < lit.size(); ++i) {
      EXPECT_NEAR(whole.masks[0].mean.pixels[i], lit[i] / samples, 1e-6) << samples << ' ' << i;
      mixed += lit[i] > 0 && lit[i] < samples ? 1 : 0;
    }
    EXPECT_GT(mixed, 20);
  }
}

// Edges and shadows of edges are straight and a pixel apart, but for corners.
TEST(Antialias, PixelsThatAreLeftOutNeedNothing) {
  const Scene scene = sunny_floor();
  const FrameResult some = draw_with(scene, settings_of(16)), all = draw_with(scene, settings_of(16, true));
  EXPECT_LT(some.antialias.samples, all.antialias.samples / 8);
  int differing = 0;
  for (std::size_t i = 0; i < all.image.pixels.size(); ++i) {
    const int apart = std::abs(int{all.image.pixels[i]} - int{some.image.pixels[i]});
    EXPECT_LE(apart, 255 / 16 + 1) << "more than one sample was missed at " << i;
    differing += apart > 1 ? 1 : 0;
  }
  EXPECT_LE(differing, 3 * 4) << "corners of the shadow";
}

TEST(Antialias, MeansOfMasksAreMadeWhereTheyAreWanted) {
  const Scene scene = sunny_floor();
  RenderSettings settings = settings_of(4);
  const FrameResult with = draw_with(scene, settings);
  EXPECT_EQ(with.masks[0].mean.pixels.size(), std::size_t{width} * height);
  EXPECT_TRUE(with.masks[0].samples.empty());
  settings.mask_means = false;
  const FrameResult without = draw_with(scene, settings);
  EXPECT_TRUE(without.masks[0].mean.pixels.empty());
  EXPECT_EQ(without.image, with.image);
  settings.sample_masks = true;
  EXPECT_EQ(draw_with(scene, settings).masks[0].samples.size(), 4u);
}

TEST(Antialias, WithoutShadowsEdgesAreAsSmooth) {
  const Scene scene = sunny_floor();
  RenderSettings settings = settings_of(16), everywhere = settings_of(16, true);
  settings.shadows = everywhere.shadows = render::ShadowMode::none;
  const FrameResult some = draw_with(scene, settings), all = draw_with(scene, everywhere);
  EXPECT_GT(some.antialias.pixels, 50u);
  for (std::size_t i = 0; i < all.image.pixels.size(); ++i)
    EXPECT_NEAR(some.image.pixels[i], all.image.pixels[i], 1) << i;
}

// A lamp close to the floor: neighbours differ by some levels, but nearly all as much as the next ones.
TEST(Antialias, RampsOfLightNeedFewSamples) {
  Scene scene = white_floor(false);
  scene.transfer = Transfer::display;
  add_light(scene, {.name = "lamp", .type = LightType::point, .intensity = 1.8f}, {0.2, 0.8, 0.1},
            facing_down);
  for (const int samples : {8, 16}) {
    const FrameResult some = draw_with(scene, settings_of(samples)),
                      all = draw_with(scene, settings_of(samples, true));
    EXPECT_LT(some.antialias.pixels, 100u);
    EXPECT_GT(some.antialias.pixels, 5u);
    for (std::size_t i = 0; i < all.image.pixels.size(); ++i)
      EXPECT_NEAR(some.image.pixels[i], all.image.pixels[i], 4) << samples << ' ' << i;
  }
}

// Edges that no shadow is near are shaded without masks of their samples, unless these are asked for.
TEST(Antialias, ThePictureIsTheSameWithMasksOfSamples) {
  for (const int samples : {2, 4, 16}) {
    Scene scene = sunny_floor();
    add_light(scene, {.name = "lamp", .type = LightType::point, .intensity = 9.0f}, {1, 3, 1}, facing_down);
    RenderSettings settings = settings_of(samples);
    const FrameResult with = draw_with(scene, settings);
    settings.mask_means = false;
    EXPECT_EQ(draw_with(scene, settings).image, with.image) << samples;
  }
}

TEST(Antialias, MeansAreThoseOfTheSamplesMasks) {
  const Scene scene = sunny_floor();
  RenderSettings settings = settings_of(8);
  settings.sample_masks = true;
  const FrameResult result = draw_with(scene, settings);
  const render::LightMask& mask = result.masks[0];
  ASSERT_EQ(mask.samples.size(), 8u);
  EXPECT_EQ(mask.samples[0], mask.mask);
  for (std::size_t i = 0; i < mask.mask.pixels.size(); ++i) {
    int lit = 0;
    for (const io::Image8& sample : mask.samples) lit += sample.pixels[i] != 0 ? 1 : 0;
    EXPECT_FLOAT_EQ(mask.mean.pixels[i], static_cast<float>(lit) / 8);
  }
}

TEST(Antialias, TheSameBitsWithAnyThreadsVectorsAndTracer) {
  const Scene scene = sunny_floor();
  RenderSettings settings = settings_of(4);
  settings.threads = 1;
  const FrameResult expected = draw_with(scene, settings);
  settings.threads = 3;
  EXPECT_EQ(draw_with(scene, settings).image, expected.image);
  settings.hard.simd = SimdLevel::scalar;
  EXPECT_EQ(draw_with(scene, settings).image, expected.image);
  settings.hard.variant = Variant::precise_sorted;
  EXPECT_EQ(draw_with(scene, settings).image, expected.image);
}

// A soft light: samples of one surface share their pixel's irradiance, those that no centre sees have their
// own.
TEST(Antialias, SoftShadowsAreTakenOnceAPixelAndSurface) {
  Scene scene = white_floor(true);
  scene.transfer = Transfer::display;
  add_light(scene, {.name = "panel", .type = LightType::area_rect, .intensity = 2.0f, .size_m = {1, 1}},
            {0, 4, 0}, facing_down);
  RenderSettings settings = settings_of(16);
  settings.shadows = render::ShadowMode::soft;
  const FrameResult some = draw_with(scene, settings);
  settings.antialias_everywhere = true;
  const FrameResult all = draw_with(scene, settings);
  settings.antialias = 1, settings.antialias_everywhere = false;
  const FrameResult one = draw_with(scene, settings);
  const auto apart = [&](const FrameResult& a) {
    double sum = 0;
    for (std::size_t i = 0; i < all.image.pixels.size(); ++i) {
      const double d = double{a.image.pixels[i] * 1.0} - all.image.pixels[i];
      sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(all.image.pixels.size()));
  };
  EXPECT_LT(apart(some), 1.0);
  EXPECT_GT(apart(one), 2 * apart(some));
  ASSERT_EQ(some.masks[0].mean.pixels.size(), one.masks[0].visible_fraction.pixels.size());
}

// Glass before the floor: samples of pixels at its edge see through it or past it.
TEST(Antialias, SeeThroughLayersHaveSamplesToo) {
  Scene scene = sunny_floor();
  Material glass{.name = "glass", .base_color = vec3(0.2f, 0.8f, 0.2f)};
  glass.alpha_mode = AlphaMode::blend;
  glass.alpha = 0.5f;
  scene.materials.push_back(glass);
  Mesh pane{.name = "pane"};
  add_quad(pane, {2, 0.5f, 3}, {2.3f, 0.4f, 0.2f}, {0.3f, 0.8f, -2.1f}, 1);
  add_mesh(scene, std::move(pane));
  const FrameResult some = draw_with(scene, settings_of(16)), all = draw_with(scene, settings_of(16, true)),
                    one = draw_with(scene, settings_of(1));
  int better = 0, off = 0;
  for (std::size_t i = 0; i < all.image.pixels.size(); ++i) {
    const int with = std::abs(int{all.image.pixels[i]} - int{some.image.pixels[i]}),
              without = std::abs(int{all.image.pixels[i]} - int{one.image.pixels[i]});
    better += without > with + 4 ? 1 : 0;
    off += with > 16 ? 1 : 0;
  }
  EXPECT_GT(better, 300);
  EXPECT_EQ(off, 0);
}

TEST(Antialias, CountsThatAreNoneAreRefused) {
  const Scene scene = sunny_floor();
  render::Renderer renderer = cpu_renderer(scene);
  FrameResult result;
  for (const int samples : {0, 3, 5, 32, 256}) {
    const auto drawn = renderer.render_frame(frame_of(scene, width, height), settings_of(samples), result);
    ASSERT_FALSE(drawn) << samples;
    EXPECT_NE(drawn.error().message.find("anti-aliasing"), std::string::npos);
  }
}

}  // namespace
}  // namespace tenebra
