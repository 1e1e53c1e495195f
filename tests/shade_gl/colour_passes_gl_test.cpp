// OpenGL's colours against the CPU's, over random scenes: the two texts of the formulas say the same.
#include "shade_gl/passes_fixture.h"

namespace tenebra {
namespace {

class ColourPasses : public PassesTest {};

/// Levels that differ by more than one, of 1,000 samples; and the largest difference of all.
struct Apart {
  double permille = 0;
  float most = 0;
};
Apart levels_apart(const std::vector<shade::ShadedSample>& a, const std::vector<shade::ShadedSample>& b) {
  constexpr float exposure = 0.3f;
  Apart out;
  int apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    float most = 0;
    for (int c = 0; c < 3; ++c)
      most = std::max(most, std::abs(level_of(a[i].color[c], exposure) - level_of(b[i].color[c], exposure)));
    apart += most > 1.0f ? 1 : 0;
    out.most = std::max(out.most, most);
  }
  out.permille = 1000.0 * apart / static_cast<double>(a.size());
  return out;
}

/// `permille`: of the samples that may be more than a level apart. `alpha`: how far that may be.
void expect_alike(shade_gl::ColourPasses& passes, const RandomScene& scene, const shade::Samples& samples,
                  const char* what, double permille = 1.0, float alpha = 1e-6f) {
  ASSERT_EQ(shade_gl::lacks(scene.subject(), scene.lighting()), "");
  std::vector<shade::ShadedSample> cpu, gl;
  shade::shade_samples(scene.subject(), scene.lighting(), samples, cpu);
  const auto begun = passes.begin(scene.subject(), scene.lighting(), {});
  ASSERT_TRUE(begun) << begun.error().message;
  const auto done = passes.shade_samples(samples, gl);
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(gl.size(), cpu.size());
  const Apart apart = levels_apart(cpu, gl);
  EXPECT_LE(apart.permille, permille)
      << what << ": samples more than a level apart, the worst by " << apart.most;
  for (std::size_t i = 0; i < cpu.size(); ++i)
    ASSERT_NEAR(cpu[i].alpha, gl[i].alpha, alpha) << what << " " << i;
}

TEST_P(ColourPasses, AreTheCpusForAllSurfacesAndLights) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    RandomScene scene(seed);
    expect_alike(passes(), scene, scene.samples(), "all");
    scene.smooth_terminator = false;
    expect_alike(passes(), scene, scene.samples(), "flat terminator");
  }
}

TEST_P(ColourPasses, AreTheCpusWithTextures) {
  RandomScene scene(8), parallel(9, true);
  for (RandomScene* each : {&scene, &parallel}) {
    each->add_textures(false);
    expect_alike(passes(), *each, each->samples(), "textures", 1.0, 1e-4f);
  }
}

// On small triangles places on textures differ by the roundings of floats, which normals of noise make larger
// at glossy samples: with all other maps alone no more than one sample of 1,000 is apart.
TEST_P(ColourPasses, AreTheCpusWithTexturesAndNormalMaps) {
  constexpr double permille = 2.0;
  constexpr float alpha = 1e-4f;
  RandomScene scene(8), parallel(9, true);
  for (RandomScene* each : {&scene, &parallel}) {
    each->add_textures();
    expect_alike(passes(), *each, each->samples(), "textures", permille, alpha);
    each->geometry.tangents.clear();
    each->geometry.normals.clear();
    expect_alike(passes(), *each, each->samples(), "without normals and tangents", permille, alpha);
  }
}

TEST_P(ColourPasses, AreTheCpusForEachLightAlone) {
  RandomScene scene(4);
  const std::vector<shade::DrawnLight> all = scene.lights;
  for (std::size_t i = 0; i < all.size(); ++i) {
    scene.lights = {all[i]};
    const std::vector<shade::LightFactors> factors{scene.factors[i]};
    shade::Samples samples = scene.samples();
    samples.factors = factors;
    expect_alike(passes(), scene, samples, ("light " + std::to_string(i)).c_str());
  }
}

TEST_P(ColourPasses, AreTheCpusWithParallelRays) {
  RandomScene scene(5, true);
  expect_alike(passes(), scene, scene.samples(), "orthographic");
}

TEST_P(ColourPasses, FollowAFrameAfterAnother) {
  RandomScene scene(6);
  expect_alike(passes(), scene, scene.samples(), "first");
  for (glm::vec3& position : scene.geometry.positions) position.x += 0.01f;
  scene.materials[3].base_color = {1, 0, 0};
  scene.surfaces.set_factors(scene.materials);
  shade::Samples some = scene.samples();
  some.ids = some.ids.first(1000);
  some.places = some.places.first(1000);
  some.openness = {};
  expect_alike(passes(), scene, some, "moved");
  EXPECT_GT(passes().traffic().sent_bytes, 0u);
  EXPECT_EQ(passes().traffic().waits, 1);
}

TEST_P(ColourPasses, MakeThePicturesOfEveryTone) {
  RandomScene scene(7);
  constexpr int width = 59, height = 37;  // no multiples of anything
  constexpr auto count = std::size_t{width * height};
  const std::vector<std::uint32_t> ids = scene.ids_seen(width, height);
  const std::vector<shade::LightFactors> factors = scene.factors;
  const shade::PixelSamples pixels{width, height, ids, factors, scene.openness};
  for (const shade::Tone tone : shade::tones) {
    for (const Transfer transfer : {Transfer::srgb, Transfer::display}) {
      const shade::Display display{0.4f, tone, transfer};
      io::Image8 cpu, gl;
      shade::shade_picture(scene.subject(), scene.lighting(), pixels, display, cpu);
      ASSERT_TRUE(passes().begin(scene.subject(), scene.lighting(), display));
      const auto done = passes().shade_centres(pixels, gl);
      ASSERT_TRUE(done) << done.error().message;
      ASSERT_EQ(gl.pixels.size(), cpu.pixels.size());
      std::size_t apart = 0;
      for (std::size_t i = 0; i < cpu.pixels.size(); ++i) apart += std::abs(cpu.pixels[i] - gl.pixels[i]) > 1;
      EXPECT_LE(apart, cpu.pixels.size() / 1000) << shade::tone_name(tone);
      io::ImageF linear;
      ASSERT_TRUE(passes().read_centres(linear));
      for (std::size_t i = 0; i < count; ++i) {  // exactly what these colours show
        std::uint8_t levels[3];
        const glm::vec3 color(linear.pixels[3 * i], linear.pixels[3 * i + 1], linear.pixels[3 * i + 2]);
        shade::encode_shown(display, shade::shown(display, color), levels);
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_NEAR(levels[c], gl.pixels[3 * i + c], tone == shade::Tone::none ? 0 : 1) << i;
      }
    }
  }
}

TEST_P(ColourPasses, MakeMeansOfSamplesAndCentres) {
  RandomScene scene(8);
  constexpr int width = 20, height = 10;
  const std::vector<std::uint32_t> ids = scene.ids_seen(width, height);
  const shade::Display display{0.4f, shade::Tone::neutral, Transfer::srgb};
  const shade::PixelSamples pixels{width, height, ids, scene.factors, {}};
  ASSERT_TRUE(passes().begin(scene.subject(), scene.lighting(), display));
  io::Image8 picture;
  io::ImageF centres;
  std::vector<shade::ShadedSample> colors;
  ASSERT_TRUE(passes().shade_centres(pixels, picture));
  ASSERT_TRUE(passes().read_centres(centres));
  ASSERT_TRUE(passes().shade_samples(scene.samples(), colors));
  const io::Image8 before = picture;

  // Pixels 3, 8, 13 ...: the last two get no sample; sample counts vary, shares too.
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 3; i < 150; i += 5) chosen.push_back(i);
  std::vector<std::uint32_t> of;
  std::vector<float> shares, of_centres;
  std::vector<glm::vec3> sums;
  const auto shown_centre = [&](std::size_t k) {
    const float* c = &centres.pixels[3 * std::size_t{chosen[k]}];
    return shade::shown(display, {c[0], c[1], c[2]});
  };
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    of_centres.push_back(k % 4 == 0 ? 1.0f : 0.0f);
    sums.push_back((1.0f + of_centres.back()) * shown_centre(k));
    for (std::size_t s = 0; s < k % 3 && k + 2 < chosen.size(); ++s) {
      sums[k] += (1.0f + static_cast<float>(s)) * shade::shown(display, colors[of.size()].color);
      of.push_back(static_cast<std::uint32_t>(k));
      shares.push_back(1.0f + static_cast<float>(s));
    }
  }
  for (const bool by_color : {false, true}) {
    picture = before;
    ASSERT_TRUE(passes().begin_means(chosen, true));
    const shade_gl::Shares to{0, of, shares, of_centres};
    shade::Samples samples = scene.samples();
    samples.ids = samples.ids.first(of.size());
    samples.places = samples.places.first(of.size());
    const std::span<const shade::ShadedSample> ready(colors.data(), of.size());
    ASSERT_TRUE(by_color ? passes().add_colors(ready, to) : passes().add_samples(samples, to));
    ASSERT_TRUE(passes().finish_means(4, picture));
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const auto k = std::find(chosen.begin(), chosen.end(), i) - chosen.begin();
      std::uint8_t levels[3] = {before.pixels[3 * i], before.pixels[3 * i + 1], before.pixels[3 * i + 2]};
      if (static_cast<std::size_t>(k) < chosen.size())
        shade::encode_shown(display, 0.25f * sums[static_cast<std::size_t>(k)], levels);
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(levels[c], picture.pixels[3 * i + c], 1) << i << by_color;
    }
  }
}

TEST_P(ColourPasses, SayWhatTheyLack) {
  RandomScene scene(9);
  EXPECT_EQ(shade_gl::lacks(scene.subject(), scene.lighting()), "");
  const shade::Environment environment(io::ImageF{1, 1, 3, {1, 1, 1}});
  shade::Lighting lighting = scene.lighting();
  lighting.environment = &environment;
  EXPECT_NE(shade_gl::lacks(scene.subject(), lighting), "");
  lighting = scene.lighting();
  const std::vector<shade::DrawnLight> many(shade_gl::most_lights + 1, scene.lights[0]);
  lighting.lights = many;
  EXPECT_NE(shade_gl::lacks(scene.subject(), lighting), "");
  scene.geometry.triangles.clear();
  EXPECT_NE(shade_gl::lacks(scene.subject(), scene.lighting()), "");
}

TENEBRA_BOTH_CONTEXTS(ColourPasses);

}  // namespace
}  // namespace tenebra
