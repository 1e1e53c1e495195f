// Textures and vertex colours on triangles: where they are looked up, and with which footprint.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "parallel/parallel.h"
#include "shade/shading.h"
#include "support/hand_made.h"
#include "support/sample_one.h"
#include "texture/bilinear.h"

namespace tenebra {
namespace {

constexpr int width = 37, height = 29;

/// A parallelogram, far larger than the view, that runs away from the eye, with texture coordinates that are
/// linear over its plane, and colours at its vertices.
class Textured : public ::testing::Test {
protected:
  Textured() {
    Mesh mesh;
    for (const glm::vec2& corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
      mesh.positions.emplace_back(centre + corner.x * half_x + corner.y * half_y);
      mesh.texture_coordinates[0].emplace_back(20.0f * corner + glm::vec2(0.3f, 0.1f));
      mesh.texture_coordinates[1].emplace_back(-7.0f * glm::vec2(corner.y, corner.x));
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.materials = {0, 0};
    scene.meshes.push_back(mesh);
    scene.nodes.push_back({.mesh = 0});
    scene.transfer = Transfer::display;
    std::mt19937 random(17);
    TextureImage image{"noise", 24, 10, {}};
    for (int i = 0; i < 4 * 24 * 10; ++i) image.rgba.push_back(static_cast<std::uint8_t>(random() >> 24));
    scene.images.push_back(image);
    Material m;
    m.model = SurfaceModel::unlit;
    m.base_color = {0.5f, 1.0f, 0.25f};
    m.base_color_map.image = 0;
    m.base_color_map.wrap_v = Wrap::mirrored_repeat;
    scene.materials.push_back(m);
  }

  /// The plane's coordinates (-1 to 1) that place (x, y) of the view sees.
  glm::dvec2 seen(const ViewRays& view, double x, double y) const {
    const glm::dvec3 across = x * glm::dvec3(view.dx) + y * glm::dvec3(view.dy);
    const glm::dvec3 origin = glm::dvec3(view.eye) + (view.orthographic ? across : glm::dvec3(0.0));
    const glm::dvec3 ray = glm::dvec3(view.d0) + (view.orthographic ? glm::dvec3(0.0) : across);
    const glm::dvec3 n = glm::cross(glm::dvec3(half_x), glm::dvec3(half_y));
    const glm::dvec3 p = origin + glm::dot(n, glm::dvec3(centre) - origin) / glm::dot(n, ray) * ray;
    const glm::dvec3 from = p - glm::dvec3(centre);
    return {glm::dot(from, glm::dvec3(half_x)) / glm::dot(half_x, half_x),
            glm::dot(from, glm::dvec3(half_y)) / glm::dot(half_y, half_y)};
  }
  glm::vec2 coordinates(const ViewRays& view, double x, double y) const {
    return glm::vec2(20.0 * seen(view, x, y)) + glm::vec2(0.3f, 0.1f);
  }
  /// The triangle of a place: the second one above the diagonal.
  std::uint32_t id(const ViewRays& view, double x, double y) const {
    const glm::dvec2 place = seen(view, x, y);
    return place.y > place.x ? 1 : 0;
  }

  std::vector<shade::ShadedSample> shaded(const ViewRays& view, const shade::Lighting& lighting = {}) const {
    FrameGeometry geometry;
    evaluate_frame(scene, -1, 0, geometry);
    const shade::SurfaceTable surfaces(scene);
    std::vector<std::uint32_t> ids;
    std::vector<glm::vec2> places;
    for (int i = 0; i < width * height; ++i) {
      places.emplace_back(static_cast<float>(i % width) + 0.5f, static_cast<float>(i / width) + 0.5f);
      ids.push_back(id(view, places.back().x, places.back().y));
    }
    std::vector<shade::ShadedSample> out;
    shade::shade_samples({geometry, view, surfaces}, lighting, {ids, places, {}, {}}, out);
    return out;
  }

  glm::vec3 centre{0, -1, -30}, half_x{40, 0, 0}, half_y{0, 3, -29};
  Scene scene;
};

const ViewRays near_view = forward_view({0, 0, 0}, 6000.0f, width, height);  // pixels smaller than texels
const ViewRays far_view = forward_view({0, 0, 0}, 30.0f, width, height);
const ViewRays flat_view = orthographic_view({0, 0, 0}, 0.7f, width, height);

TEST_F(Textured, EnlargedItIsTheBilinearPictureTimesTheFactor) {
  const Material& m = scene.materials[0];
  const auto found = shaded(near_view);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double x = double(i % width) + 0.5, y = double(i / width) + 0.5;
    const glm::vec4 value =
        texture::sample_bilinear(scene.images[0], m.base_color_map, coordinates(near_view, x, y));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i].color[c], m.base_color[c] * value[c], 1e-3) << i;
  }
}

TEST_F(Textured, TransformsAndTheSecondSetAreUsed) {
  TextureMap& map = scene.materials[0].base_color_map;
  map.uv_set = 1;
  map.transform = {0.5f, 0.25f, -0.25f, 0.5f, 0.1f, 0.2f};
  const auto found = shaded(near_view);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const glm::dvec2 place = seen(near_view, double(i % width) + 0.5, double(i / width) + 0.5);
    const glm::vec2 uv = -7.0f * glm::vec2(place.y, place.x);
    EXPECT_NEAR(found[i].color.y, texture::sample_bilinear(scene.images[0], map, uv).y, 1e-3) << i;
  }
}

// The footprint from differences of a thousandth of a pixel, in double.
TEST_F(Textured, FootprintsAreTheDerivativesOverThePlane) {
  const Material& m = scene.materials[0];
  const texture::MipTexture picture(scene.images[0], texture::Content::display_color, m.base_color_map.wrap_u,
                                    m.base_color_map.wrap_v);
  for (const ViewRays& view : {far_view, flat_view}) {
    const auto found = shaded(view);
    int smaller = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double x = double(i % width) + 0.5, y = double(i / width) + 0.5, h = 1e-3;
      const glm::dvec2 at = seen(view, x, y);
      const Footprint footprint{20.0 / h * (seen(view, x + h, y) - at),
                                20.0 / h * (seen(view, x, y + h) - at)};
      if (!(glm::length(footprint.dx) < 1e3f && std::abs(at.x) < 1 && std::abs(at.y) < 1)) continue;
      smaller += glm::length(footprint.dx) > 2.0f / 24;
      const glm::vec4 value = sample_one(picture, m.base_color_map, coordinates(view, x, y), footprint);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i].color[c], m.base_color[c] * value[c], 0.02) << i;
    }
    EXPECT_GT(smaller, 50);
  }
}

TEST_F(Textured, VertexColoursMultiplyColourAndAlpha) {
  Mesh& mesh = scene.meshes[0];
  mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 0.5f}, {0, 0, 1, 0}, {1, 1, 1, 1}};
  Material& m = scene.materials[0];
  m.base_color_map.image = -1;
  m.alpha_mode = AlphaMode::blend;
  m.alpha = 0.5f;
  const auto found = shaded(near_view);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double x = double(i % width) + 0.5, y = double(i / width) + 0.5;
    const glm::vec2 at = seen(near_view, x, y), st = 0.5f * (at + 1.0f);
    const glm::vec4 expected =
        id(near_view, x, y) == 0
            ? (1 - st.x) * mesh.colors[0] + (st.x - st.y) * mesh.colors[1] + st.y * mesh.colors[2]
            : (1 - st.y) * mesh.colors[0] + st.x * mesh.colors[2] + (st.y - st.x) * mesh.colors[3];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i].color[c], m.base_color[c] * expected[c], 1e-4) << i;
    EXPECT_NEAR(found[i].alpha, 0.5 * expected.a, 1e-4);
  }
}

TEST_F(Textured, WithoutImageOrCoordinatesTheFactorStandsAlone) {
  const glm::vec3 factor = scene.materials[0].base_color;
  const auto expect_factor = [&] {
    for (const auto& sample : shaded(near_view)) EXPECT_EQ(sample.color, factor);
  };
  scene.materials[0].base_color_map.image = 5;
  expect_factor();
  scene.materials[0].base_color_map.image = 0;
  scene.materials[0].base_color_map.uv_set = 1;
  scene.meshes[0].texture_coordinates[1].clear();
  expect_factor();
  scene.materials[0].base_color_map.uv_set = 0;
  scene.images[0].rgba.clear();
  expect_factor();
}

// BART's garden: lit by ambient light alone.
TEST_F(Textured, AnAmbientColourIsTexturedWhereTheBaseIsBlack) {
  Material& m = scene.materials[0];
  m.model = SurfaceModel::phong;
  m.base_color = glm::vec3(0.0f);
  m.ambient = {0.5f, 0.25f, 1.0f};
  scene.meshes[0].colors.assign(4, {1, 1, 0.5f, 1});
  const auto found = shaded(near_view, {.ambient_light = {2, 1, 1}});
  const glm::vec3 factor{1, 0.25f, 0.5f};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double x = double(i % width) + 0.5, y = double(i / width) + 0.5;
    const glm::vec4 value =
        texture::sample_bilinear(scene.images[0], m.base_color_map, coordinates(near_view, x, y));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i].color[c], factor[c] * value[c], 1e-3) << i;
  }
}

TEST_F(Textured, MetalsAndEmissiveColoursAreTextured) {
  Material& m = scene.materials[0];
  m.model = SurfaceModel::metallic_roughness;
  m.emissive = {2, 1, 1};
  m.emissive_map.image = 0;
  m.emissive_map.wrap_v = Wrap::mirrored_repeat;
  const auto found = shaded(near_view, {.ambient_light = glm::vec3(0.0f)});
  for (std::size_t i = 0; i < found.size(); ++i) {
    const glm::vec4 value =
        texture::sample_bilinear(scene.images[0], m.base_color_map,
                                 coordinates(near_view, double(i % width) + 0.5, double(i / width) + 0.5));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i].color[c], m.emissive[c] * value[c], 3e-3) << i;
  }
}

TEST_F(Textured, SrgbTexturesAreDecodedAndDisplayOnesNot) {
  TextureImage& image = scene.images[0];
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = i % 4 == 3 ? 255 : 188;
  scene.materials[0].base_color = glm::vec3(1.0f);
  for (const ViewRays& view : {near_view, far_view}) {
    scene.transfer = Transfer::display;
    EXPECT_NEAR(shaded(view)[40].color.x, 188 / 255.0, 1e-5);
    scene.transfer = Transfer::srgb;
    EXPECT_NEAR(shaded(view)[40].color.x, std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-5);
  }
}

// Textures of two sizes and transforms, gloss, colours of vertices, lights and an environment.
TEST_F(Textured, AllVectorLevelsAndThreadCountsGiveTheSameBits) {
  scene.meshes[0].colors = {{1, 0, 0, 1}, {0, 1, 0, 0.5f}, {0, 0, 1, 0}, {1, 1, 1, 1}};
  scene.images.push_back({"plain", 3, 5, std::vector<std::uint8_t>(60, 77)});
  Material& m = scene.materials[0];
  m.model = SurfaceModel::metallic_roughness;
  m.metallic = 0.5f;
  m.emissive = {0.1f, 0.2f, 0.3f};
  m.emissive_map = {.image = 1, .uv_set = 1, .wrap_u = Wrap::clamp_to_edge, .magnify = Filter::nearest};
  m.metallic_roughness_map = {.image = 0, .transform = {0.5f, 0.25f, -0.25f, 0.5f, 0.1f, 0.2f}};
  io::ImageF sky{7, 4, 3, {}};
  for (int i = 0; i < 84; ++i) sky.pixels.push_back(0.01f * static_cast<float>(i));
  const shade::Environment environment(sky);
  const std::vector<shade::DrawnLight> lights{
      {make_light(LightType::point, 900.0f), {.position = {1, 5, -12}}},
      {make_light(LightType::directional, 0.5f), {.direction = glm::normalize(glm::vec3(1, -2, 0.5f))}}};
  const std::vector<shade::LightFactors> factors(2);
  FrameGeometry geometry;
  evaluate_frame(scene, -1, 0, geometry);
  const shade::SurfaceTable surfaces(scene);
  for (const ViewRays& view : {near_view, far_view, flat_view}) {
    std::vector<std::uint32_t> ids;
    for (int i = 0; i < width * height; ++i)
      ids.push_back(i % 11 == 0 ? background_id : id(view, double(i % width) + 0.5, double(i / width) + 0.5));
    for (const shade::Environment* around : {static_cast<const shade::Environment*>(nullptr), &environment}) {
      const auto drawn = [&](SimdLevel level, int threads) {
        io::Image8 image;
        with_threads(threads, [&] {
          shade::shade_picture({geometry, view, surfaces},
                               {.lights = lights, .environment = around, .simd = level},
                               {width, height, ids, factors, {}}, {}, image);
        });
        return image.pixels;
      };
      const auto expected = drawn(SimdLevel::scalar, 1);
      EXPECT_GT(std::set<std::uint8_t>(expected.begin(), expected.end()).size(), 10u);
      for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512})
        for (const int threads : {1, 2, 5})
          if (simd_level_supported(level)) {
            EXPECT_EQ(drawn(level, threads), expected) << simd_level_name(level) << " " << threads;
          }
    }
  }
}

}  // namespace
}  // namespace tenebra
