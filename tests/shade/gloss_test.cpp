// What mirrors: Phong's and GGX's lobes against the formulas of docs/materials.md in double, area lights in
// the limit of small ones, and uniform surroundings that must stay as they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "shade/kernels.h"
#include "shade/shading.h"
#include "support/hand_made.h"

namespace tenebra {
namespace {

using glm::dvec3;
using std::numbers::pi;
constexpr int gloss_width = 40, gloss_height = 30;

/// A wall at z = -5 before an eye at the origin, all of one material.
class Gloss : public ::testing::Test {
protected:
  Gloss() { add_triangle(geometry, {-100, -100, -5}, {100, -100, -5}, {0, 200, -5}); }

  std::vector<shade::ShadedSample> shaded(const Material& material, const shade::Lighting& lighting,
                                          std::span<const shade::LightFactors> factors) const {
    const shade::SurfaceTable surfaces(std::span(&material, 1));
    std::vector<std::uint32_t> ids(gloss_width * gloss_height, 0);
    std::vector<glm::vec2> places;
    for (int i = 0; i < gloss_width * gloss_height; ++i) {
      places.emplace_back(static_cast<float>(i % gloss_width) + 0.5f,
                          static_cast<float>(i / gloss_width) + 0.5f);
    }
    std::vector<shade::ShadedSample> out;
    shade::shade_samples({geometry, view, surfaces}, lighting, {ids, places, factors, {}}, out);
    return out;
  }
  dvec3 point(std::size_t i) const {
    const dvec3 ray = dvec3(view.d0) + (double(i % gloss_width) + 0.5) * dvec3(view.dx) +
                      (double(i / gloss_width) + 0.5) * dvec3(view.dy);
    return ray * (-5 / ray.z);
  }

  FrameGeometry geometry;
  ViewRays view = forward_view({0, 0, 0}, 20.0f, gloss_width, gloss_height);
};

Material metal_or_not(glm::vec3 color, float metallic, float roughness) {
  Material m;
  m.model = SurfaceModel::metallic_roughness;
  m.base_color = color;
  m.ambient = glm::vec3(0.0f);
  m.metallic = metallic;
  m.roughness = roughness;
  return m;
}

/// glTF 2.0, appendix B, times the cosine: to light `l`, to the eye `v`, normal `n`.
dvec3 gltf_brdf(const Material& m, const dvec3& l, const dvec3& v, const dvec3& n) {
  const dvec3 h = glm::normalize(l + v), base(m.base_color);
  const double alpha = double(m.roughness) * m.roughness, a2 = alpha * alpha;
  const double nh = glm::dot(n, h), nl = glm::dot(n, l), nv = glm::dot(n, v), vh = glm::dot(v, h);
  const double d = a2 / (pi * std::pow(nh * nh * (a2 - 1) + 1, 2));
  const double vis =
      0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
  const dvec3 f0 = glm::mix(dvec3(0.04), base, double(m.metallic));
  const dvec3 f = f0 + (1.0 - f0) * std::pow(1 - vh, 5);
  const dvec3 diffuse = glm::mix(base, dvec3(0.0), double(m.metallic));
  return ((1.0 - f) * diffuse / pi + f * d * vis) * nl;
}

TEST_F(Gloss, MetallicRoughnessIsThatOfGltf) {
  const Light lamp = make_light(LightType::point, 30.0f);
  const std::vector<shade::DrawnLight> lights{{lamp, {.position = {1, 0.5f, -2}}}};
  const std::vector<shade::LightFactors> lit(1);
  for (const float roughness : {0.1f, 0.4f, 1.0f}) {
    for (const float metallic : {0.0f, 0.3f, 1.0f}) {
      const Material m = metal_or_not({0.9f, 0.5f, 0.2f}, metallic, roughness);
      const auto found = shaded(m, {.lights = lights, .ambient_light = glm::vec3(0.0f)}, lit);
      for (std::size_t i = 0; i < found.size(); ++i) {
        const dvec3 p = point(i), path = dvec3(lights[0].placed.position) - p;
        const double square = glm::dot(path, path);
        const dvec3 expected =
            30.0 / square * gltf_brdf(m, glm::normalize(path), glm::normalize(-p), {0, 0, 1});
        for (int c = 0; c < 3; ++c) {
          // A narrow lobe magnifies what rounding does to the half vector.
          const double relative = 2e-5 + 2e-7 / std::pow(roughness, 4.0);
          ASSERT_NEAR(found[i].color[c], expected[c], relative * expected[c] + 1e-6)
              << roughness << " " << metallic;
        }
      }
    }
  }
}

// KHR_materials_transmission: what passes is taken from the diffuse part; the mirror image stays whole.
TEST_F(Gloss, WhatPassesIsTakenFromWhatIsDiffuseAlone) {
  const Light lamp = make_light(LightType::point, 30.0f);
  const std::vector<shade::DrawnLight> lights{{lamp, {.position = {1, 0.5f, -2}}}};
  const std::vector<shade::LightFactors> lit(1);
  const shade::Lighting lighting{.lights = lights, .ambient_light = glm::vec3(0.3f)};
  Material m = metal_or_not({0.9f, 0.5f, 0.2f}, 0, 0.3f);
  m.ambient = glm::vec3(-1.0f);
  const auto opaque = shaded(m, lighting, lit);
  m.tinted_transmission = true;
  m.transmission = 1;
  const auto clear = shaded(m, lighting, lit);
  m.base_color = glm::vec3(0.0f);
  m.transmission = 0;
  const auto black = shaded(m, lighting, lit);  // f0 is 0.04 whatever the colour: the mirror image alone
  m.base_color = {0.9f, 0.5f, 0.2f};
  m.transmission = 0.75f;
  const auto dim = shaded(m, lighting, lit);
  float brightest = 0;
  for (std::size_t i = 0; i < opaque.size(); ++i) {
    brightest = std::max(brightest, black[i].color.x);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(clear[i].color[c], black[i].color[c]);
      const float expected = black[i].color[c] + 0.25f * (opaque[i].color[c] - black[i].color[c]);
      EXPECT_NEAR(dim[i].color[c], expected, 1e-6f * opaque[i].color[c]);
    }
  }
  EXPECT_GT(brightest, 0.5f);
}

TEST_F(Gloss, PhongsHighlightIsAPowerOfTheMirroredRaysCosine) {
  Material m = make_material({0.3f, 0.2f, 0.1f}, glm::vec3(0.0f));
  m.specular = {0.5f, 0.25f, 1.0f};
  const Light lamp = make_light(LightType::point, 0.7f, Falloff::none);
  const std::vector<shade::DrawnLight> lights{{lamp, {.position = {1, 0.5f, -2}}}};
  const std::vector<shade::LightFactors> lit(1);
  for (const float exponent : {1.0f, 8.5f, 200.0f}) {
    m.phong_exponent = exponent;
    const auto found = shaded(m, {.lights = lights}, lit);
    double brightest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const dvec3 p = point(i), l = glm::normalize(dvec3(lights[0].placed.position) - p),
                  v = glm::normalize(-p);
      const double aligned = std::max(0.0, glm::dot(dvec3(-v.x, -v.y, v.z), l));
      const double highlight = std::pow(aligned, double(exponent));
      brightest = std::max(brightest, highlight);
      for (int c = 0; c < 3; ++c) {
        const double expected = 0.7 * (m.base_color[c] * l.z + m.specular[c] * highlight);
        ASSERT_NEAR(found[i].color[c], expected, 1e-5 + 1e-7 * exponent);
      }
    }
    EXPECT_GT(brightest, 0.85);
  }
}

TEST_F(Gloss, NothingIsMirroredOutOfTheShadow) {
  Material m = make_material({0.3f, 0.2f, 0.1f}, glm::vec3(0.0f));
  m.specular = glm::vec3(1.0f);
  const std::vector<std::uint8_t> dark(gloss_width * gloss_height, 0);
  const std::vector<shade::LightFactors> factors{{.mask = dark}};
  const std::vector<shade::DrawnLight> in_front{
      {make_light(LightType::point, 9.0f), {.position = {0, 0, -3}}}};
  const std::vector<shade::DrawnLight> behind{{make_light(LightType::point, 9.0f), {.position = {0, 0, -9}}}};
  for (const Material& material : {m, metal_or_not(glm::vec3(1.0f), 1, 0.3f)}) {
    for (const auto& sample : shaded(material, {.lights = in_front, .ambient_light = {}}, factors))
      EXPECT_EQ(sample.color, glm::vec3(0.0f));
    const std::vector<shade::LightFactors> lit(1);
    for (const auto& sample : shaded(material, {.lights = behind, .ambient_light = {}}, lit))
      EXPECT_EQ(sample.color, glm::vec3(0.0f));
  }
}

// A small lamp with its exact irradiance mirrors as a point of the same intensity does.
TEST_F(Gloss, SmallAreaLightsMirrorAsPoints) {
  const glm::vec3 place(1, 0.5f, -2);
  const auto polygon = make_rectangle_light(place, {0.001f, 0, 0}, {0, -0.001f, 0});  // shines along -Z
  ASSERT_TRUE(polygon);
  ASSERT_LT(polygon->normal.z, -0.99);
  Material phong = make_material({0.3f, 0.2f, 0.1f}, glm::vec3(0.0f));
  phong.specular = glm::vec3(0.5f);
  phong.phong_exponent = 20;
  std::vector<float> irradiance;
  std::vector<double> at_light;
  for (std::size_t i = 0; i < gloss_width * gloss_height; ++i) {
    const dvec3 path = dvec3(place) - point(i);
    const double square = glm::dot(path, path);
    at_light.push_back(path.z / std::sqrt(square));
    irradiance.push_back(
        static_cast<float>(polygon->area_m2 * at_light[i] * path.z / (square * std::sqrt(square))));
  }
  for (const Material& m : {phong, metal_or_not({0.9f, 0.5f, 0.2f}, 0.5f, 0.4f)}) {
    const std::vector<shade::DrawnLight> point_light{
        {make_light(LightType::point, 9.0f), {.position = place}}};
    const std::vector<shade::DrawnLight> area_light{
        {make_light(LightType::point, 9.0f), {.position = place}, *polygon}};
    const std::vector<shade::LightFactors> lit(1), by_irradiance{{.irradiance = irradiance}};
    const auto expected = shaded(m, {.lights = point_light, .ambient_light = {}}, lit);
    const auto found = shaded(m, {.lights = area_light, .ambient_light = {}}, by_irradiance);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (point(i).z - place.z > -0.25 * glm::length(dvec3(place) - point(i))) continue;  // stated bound
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[i].color[c], expected[i].color[c] * at_light[i],
                    5e-3 * expected[i].color[c] + 1e-5);
      }
    }
  }
}

// The wider the light, the larger its mirror image, and none is brighter than the lamp itself.
TEST_F(Gloss, WideLightsAreMirroredWide) {
  int bright[2] = {};
  for (const int wide : {0, 1}) {
    const float half = wide ? 1.0f : 0.1f;
    const auto polygon = make_rectangle_light({0, 0, -2}, {half, 0, 0}, {0, -half, 0});
    ASSERT_TRUE(polygon);
    std::vector<float> irradiance(gloss_width * gloss_height, 0.1f);
    const std::vector<shade::DrawnLight> lights{{make_light(LightType::area_rect, 1.0f),
                                                 {.position = {0, 0, -2}, .direction = {0, 0, -1}},
                                                 *polygon}};
    const std::vector<shade::LightFactors> factors{{.irradiance = irradiance}};
    const auto found =
        shaded(metal_or_not(glm::vec3(1.0f), 1, 0.2f), {.lights = lights, .ambient_light = {}}, factors);
    float most = 0;
    for (const auto& sample : found) most = std::max(most, sample.color.x);
    for (const auto& sample : found) bright[wide] += sample.color.x > 0.5f * most;
  }
  EXPECT_GT(bright[1], 3 * bright[0]);
}

// In uniform light of radiance 1 nothing reflects more than 1, white dielectrics all of it and metals nearly.
TEST_F(Gloss, UniformSurroundingsAreReflectedWithoutGain) {
  const shade::Lighting lighting{.ambient_light = glm::vec3(1.0f), .background = glm::vec3(1.0f)};
  const shade::Environment white(io::ImageF{8, 4, 3, std::vector<float>(96, 1.0f)});
  shade::Lighting around = lighting;
  around.environment = &white;
  for (const shade::Lighting& light : {lighting, around}) {
    for (const float roughness : {0.0f, 0.3f, 0.7f, 1.0f}) {
      Material m = metal_or_not(glm::vec3(1.0f), 0, roughness);
      m.ambient = glm::vec3(-1.0f);
      for (const auto& sample : shaded(m, light, {})) EXPECT_NEAR(sample.color.x, 1, 1e-5);
      m.metallic = 1;
      for (const auto& sample : shaded(m, light, {})) {
        EXPECT_LE(sample.color.x, 1.01f);
        EXPECT_GT(sample.color.x, 0.4f) << roughness;
      }
    }
  }
}

/// Up to 64 directions at once.
std::vector<glm::vec3> seen_in(const shade::Panorama& picture, const std::vector<glm::vec3>& towards,
                               const std::vector<float>& roughness, SimdLevel level) {
  shade::SampleBlock::Channel from[3] = {}, out[3] = {}, rough = {};
  for (std::size_t i = 0; i < towards.size(); ++i) {
    for (int c = 0; c < 3; ++c) from[c][i] = towards[i][c];
    rough[i] = roughness[i];
  }
  shade::kernels(level).see(picture, from, rough, 0, towards.size(), out);
  std::vector<glm::vec3> result;
  for (std::size_t i = 0; i < towards.size(); ++i) result.emplace_back(out[0][i], out[1][i], out[2][i]);
  return result;
}

/// The definition, in double: bilinear in angles, between two copies. Up and down have the angle 0 around.
glm::dvec3 definition(const shade::Panorama& picture, const glm::dvec3& d, double roughness) {
  const auto at_level = [&](int level) {
    const int w = picture.width_of(level), h = picture.height_of(level);
    const double x = (std::atan2(d.x, 0.0 - d.z) / (2 * pi) + 0.5) * w - 0.5;
    const double y = std::acos(std::clamp(d.y / glm::length(d), -1.0, 1.0)) / pi * h - 0.5;
    const auto pixel = [&](double column, double row) {
      const int i = (static_cast<int>(column) + w) % w, j = std::clamp(static_cast<int>(row), 0, h - 1);
      return dvec3(picture.pixels[static_cast<std::size_t>(picture.starts[static_cast<std::size_t>(level)] +
                                                           j * (w + 2) + i)]);
    };
    const double c = std::floor(x), r = std::floor(y);
    return glm::mix(glm::mix(pixel(c, r), pixel(c + 1, r), x - c),
                    glm::mix(pixel(c, r + 1), pixel(c + 1, r + 1), x - c), y - r);
  };
  const double wide = 2 * roughness * roughness * picture.width / (2 * pi);
  const double level = std::clamp(std::log2(std::max(wide, 1.0)), 0.0, picture.level_count - 1.0);
  const int lower = static_cast<int>(level), upper = std::min(lower + 1, picture.level_count - 1);
  return glm::mix(at_level(lower), at_level(upper), level - lower);
}

// An angle is off by less than 1e-6 after its roundings (eight of 2^-24 of at most pi), which is 1e-6 / pi of
// the height and half of that of the width; values of at most 2 change by at most 2 from pixel to pixel.
TEST(Environment, IsSeenByItsDefinitionOnAllVectorLevels) {
  std::mt19937 random(11);
  const auto uniform = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  for (const auto& [w, h] : {std::pair{1, 1}, {5, 3}, {64, 32}, {300, 131}}) {
    io::ImageF picture{w, h, 3, {}};
    for (int i = 0; i < 3 * w * h; ++i) picture.pixels.push_back(2 * uniform());
    const shade::Environment around(picture);
    for (int round = 0; round < 20; ++round) {
      std::vector<glm::vec3> towards{{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}};
      std::vector<float> roughness(64);
      for (float& value : roughness) value = uniform();
      while (towards.size() < 64) {
        const glm::vec3 d(2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1);
        if (glm::length(d) > 0.1f) towards.push_back(glm::normalize(d));
      }
      const auto expected = seen_in(around.radiance(), towards, roughness, SimdLevel::scalar);
      for (std::size_t i = 0; i < towards.size(); ++i) {
        const dvec3 exact = definition(around.radiance(), towards[i], roughness[i]);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(expected[i][c], exact[c], 1e-5 + 2 * 1e-6 / pi * (h + 0.5 * w)) << i;
      }
      for (const SimdLevel level : {SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512})
        if (simd_level_supported(level)) {
          ASSERT_EQ(seen_in(around.radiance(), towards, roughness, level), expected);
        }
    }
  }
}

TEST_F(Gloss, MirrorsShowTheEnvironmentBehindTheEye) {
  io::ImageF picture{64, 32, 3, std::vector<float>(64 * 32 * 3, 0.0f)};
  for (std::size_t y = 0; y < 32; ++y) {
    for (std::size_t x = 0; x < 64; ++x) {
      picture.pixels[3 * (64 * y + x)] = y < 16 ? 1.0f : 0.0f;                 // red above
      picture.pixels[3 * (64 * y + x) + 1] = x < 16 || x >= 48 ? 1.0f : 0.0f;  // green towards +Z
      picture.pixels[3 * (64 * y + x) + 2] = x >= 32 ? 1.0f : 0.0f;            // blue towards +X
    }
  }
  const shade::Environment around(picture);
  const auto seen = [](const shade::Panorama& in, const glm::vec3& towards, float roughness) {
    return seen_in(in, std::vector<glm::vec3>{towards}, {roughness}, SimdLevel::automatic)[0];
  };
  EXPECT_EQ(seen(around.radiance(), glm::normalize(glm::vec3(0.5f, 0.5f, 0.7f)), 0), glm::vec3(1, 1, 1));
  EXPECT_EQ(seen(around.radiance(), glm::normalize(glm::vec3(-0.5f, -0.5f, -0.7f)), 0), glm::vec3(0, 0, 0));
  EXPECT_NEAR(seen(around.radiance(), {0, 0, 1}, 1.0f).x, 0.5f, 0.05f);
  EXPECT_NEAR(seen(around.irradiance(), {0, 1, 0}, 0).x, 1.0f, 0.02f);
  EXPECT_NEAR(seen(around.irradiance(), {0, 0, 1}, 0).x, 0.5f, 0.02f);
  Material mirror = metal_or_not(glm::vec3(1.0f), 1, 0);
  const auto found = shaded(mirror, {.environment = &around}, {});
  const auto& upper_right = found[5 * gloss_width + 30].color;
  EXPECT_GT(upper_right.x, 0.9f);
  EXPECT_GT(upper_right.y, 0.9f);
  EXPECT_GT(upper_right.z, 0.9f);
  const auto& lower_left = found[25 * gloss_width + 8].color;
  EXPECT_LT(lower_left.x, 0.1f);
  EXPECT_GT(lower_left.y, 0.9f);
  EXPECT_LT(lower_left.z, 0.1f);
}

TEST_F(Gloss, UnlitSurfacesShowTheirColour) {
  Material m = make_material({0.3f, 0.2f, 0.1f});
  m.model = SurfaceModel::unlit;
  const std::vector<shade::DrawnLight> lights{{make_light(LightType::point, 9.0f), {.position = {0, 0, -3}}}};
  for (const auto& sample : shaded(m, {.lights = lights}, std::vector<shade::LightFactors>(1))) {
    EXPECT_EQ(sample.color, m.base_color);
  }
}

}  // namespace
}  // namespace tenebra
