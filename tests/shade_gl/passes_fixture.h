// Random samples of random scenes, shaded by both ways: the CPU's colours are the measure of OpenGL's.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "gl/context.h"
#include "shade/encoder.h"
#include "shade_gl/colour_passes.h"
#include "support/contexts.h"
#include "support/hand_made.h"

namespace tenebra {

class PassesTest : public ::testing::TestWithParam<gl::ContextKind> {
protected:
  void SetUp() override {
    TENEBRA_NEEDS_CONTEXT(GetParam());
    auto created = gl::Context::create(GetParam(), {.debug = true});
    ASSERT_TRUE(created) << created.error().message;
    context_.emplace(std::move(*created));
    auto made = shade_gl::ColourPasses::create();
    ASSERT_TRUE(made) << made.error().message;
    passes_.emplace(std::move(*made));
  }
  void TearDown() override {
    passes_.reset();
    if (!context_) return;
    for (const std::string& complaint : context_->take_debug_messages()) ADD_FAILURE() << complaint;
  }
  shade_gl::ColourPasses& passes() { return *passes_; }

private:
  std::optional<gl::Context> context_;
  std::optional<shade_gl::ColourPasses> passes_;
};

#define TENEBRA_BOTH_CONTEXTS(suite)                                             \
  INSTANTIATE_TEST_SUITE_P(                                                      \
      , suite, ::testing::Values(gl::ContextKind::egl, gl::ContextKind::osmesa), \
      [](const auto& kind) { return kind.param == gl::ContextKind::egl ? "egl" : "osmesa"; })

/// A scene with all kinds of surfaces and lights, and samples of it.
struct RandomScene {
  explicit RandomScene(unsigned seed, bool orthographic = false);

  float number(float least, float most) {
    return least + (most - least) * static_cast<float>(static_cast<double>(random()) / 4294967296.0);
  }
  glm::vec3 vector(float least, float most) {
    const float x = number(least, most), y = number(least, most);
    return {x, y, number(least, most)};
  }

  /// Textures of all kinds on its surfaces, with tangents at some vertices.
  void add_textures(bool normal_maps = true);
  /// What the pixels of a picture see.
  std::vector<std::uint32_t> ids_seen(int columns, int rows) const;

  shade::Subject subject() const { return {geometry, view, surfaces, smooth_terminator}; }
  shade::Lighting lighting() const { return {lights, {0.3f, 0.2f, 0.4f}, {0.6f, 0.1f, 0.2f}}; }
  shade::Samples samples() const { return {ids, places, factors, openness}; }

  static constexpr int width = 64, height = 48;
  std::mt19937 random;
  FrameGeometry geometry;
  ViewRays view;
  bool smooth_terminator = true;
  std::vector<Material> materials;
  shade::SurfaceTable surfaces;
  std::vector<shade::DrawnLight> lights;
  std::vector<std::uint32_t> ids;
  std::vector<glm::vec2> places;
  std::vector<std::vector<std::uint8_t>> masks;
  std::vector<std::vector<float>> irradiance;
  std::vector<glm::vec3> tints;
  std::vector<std::uint8_t> coloured;
  std::vector<shade::LightFactors> factors;
  std::vector<float> openness;

private:
  void add_materials();
  void add_lights();
  void add_samples(int count);
  void add_factors();
};

inline RandomScene::RandomScene(unsigned seed, bool orthographic) : random(seed) {
  const glm::vec3 eye(1000, -2000, 500);  // far from the origin: floats are coarse there
  view =
      orthographic ? orthographic_view(eye, 0.05f, width, height) : forward_view(eye, 60.0f, width, height);
  geometry = random_soup(200, eye + glm::vec3(0, 0, -8), 4.0f, seed);
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    geometry.materials[i] = static_cast<std::uint32_t>(random() % 13);  // one more than there are
    if (i % 3 == 0) continue;                                           // no normals
    const glm::vec3 normal = vector(-1, 1);
    for (std::size_t k = 0; k < 3; ++k)
      geometry.normals[3 * i + k] = i % 3 == 1 ? normal : normal + vector(-0.5f, 0.5f);
  }
  add_materials();
  add_lights();
  add_samples(3000);
  add_factors();
}

inline void RandomScene::add_materials() {
  for (int i = 0; i < 12; ++i) {
    Material m = make_material(vector(0, 1), i % 2 == 0 ? glm::vec3(-1.0f) : vector(0, 0.4f),
                               i % 4 == 0 ? vector(0, 0.3f) : glm::vec3(0.0f));
    m.model = static_cast<SurfaceModel>(i % 4);
    m.specular = i < 4 ? glm::vec3(0.0f) : vector(0, 0.6f);
    m.phong_exponent = number(1, 80);
    m.metallic = number(0, 1);
    m.roughness = i == 5 ? 0.0f : number(0.1f, 1);
    m.alpha_mode = i % 3 == 0 ? AlphaMode::blend : AlphaMode::opaque;
    m.alpha = number(0.2f, 1);
    m.transmission = i % 5 == 0 ? number(0, 1) : 0.0f;
    m.tinted_transmission = i % 2 == 0;
    materials.push_back(m);
  }
  surfaces = shade::SurfaceTable(std::span<const Material>(materials));
}

inline void RandomScene::add_textures(bool normal_maps) {
  Scene scene;
  Mesh mesh;
  mesh.positions = geometry.positions;
  mesh.triangles = geometry.triangles;
  mesh.materials.assign(mesh.triangles.size(), 0);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const float u = number(0, 3);
    mesh.texture_coordinates[0].emplace_back(u, number(0, 3));
    const bool given = v / 3 % 4 == 0;
    geometry.tangents.emplace_back(given ? glm::normalize(vector(-1, 1)) : glm::vec3(0.0f),
                                   v / 12 % 2 == 0 ? 1.0f : -1.0f);
  }
  for (const int size : {4, 7}) {
    TextureImage& image = scene.images.emplace_back(TextureImage{"noise", size, size, {}});
    for (int i = 0; i < 4 * size * size; ++i)
      image.rgba.push_back(static_cast<std::uint8_t>(i % 4 == 2 ? 200 : 64 + random() % 128));
  }
  for (Material& m : materials) {
    TextureMap map{.image = 0, .transform = {0.5f, 0.25f, -0.25f, 0.5f, 0.1f, 0.2f}};
    m.base_color_map = m.occlusion_map = m.specular_share_map = map;
    map.transform = {-1, 0, 0, 1, 0, 0};
    m.exponent_map = m.metallic_roughness_map = map;
    if (normal_maps) m.normal_map = map;
    m.specular_map.image = 1;
    m.normal_scale = number(0, 1);
    m.occlusion_strength = number(0, 1);
    m.specular_share = number(0, 1);
    m.dielectric = vector(0, 0.2f);
  }
  scene.meshes.push_back(mesh);
  scene.nodes.push_back({.mesh = 0});
  scene.materials = materials;
  surfaces = shade::SurfaceTable(scene);
}

inline void RandomScene::add_lights() {
  const LightType types[] = {LightType::point,     LightType::spot,       LightType::directional,
                             LightType::area_rect, LightType::area_disk,  LightType::area_rect,
                             LightType::spot,      LightType::directional};
  for (const LightType type : types) {
    const std::size_t i = lights.size();
    Light light = make_light(type, number(5, 60), i % 2 == 0 ? Falloff::inverse_square : Falloff::none);
    if (type == LightType::directional || i % 2 != 0) light.intensity = number(0.1f, 1);
    light.color = vector(0.3f, 1);
    light.inner_cone_rad = 0.3f, light.outer_cone_rad = 1.1f;
    if (i % 3 == 0) light.range_m = number(5, 20);
    WorldLight placed;
    placed.position = view.eye + glm::vec3(0, 0, -8) + vector(-5, 5);
    placed.direction = glm::normalize(view.eye + glm::vec3(0, 0, -8) - placed.position);
    placed.axis_x = glm::normalize(glm::cross(placed.direction, glm::vec3(0.1f, 1, 0.2f)));
    placed.axis_y = glm::cross(placed.axis_x, placed.direction);
    shade::DrawnLight& drawn = lights.emplace_back(shade::DrawnLight{light, placed});
    const glm::vec3 half_x = 0.7f * placed.axis_x, half_y = -0.4f * placed.axis_y;
    if (i == 4) drawn.area = make_disc_light(placed.position, half_x, half_y).value();
    if (i >= 5) drawn.area = make_rectangle_light(placed.position, half_x, half_y).value();
    if (i == 7) drawn.area = make_sun(-placed.direction, 3.0).value();
  }
}

/// On triangles where they are before the camera, some a bit beside them, some on the background.
inline void RandomScene::add_samples(int count) {
  while (static_cast<int>(ids.size()) < count) {
    const auto id = static_cast<std::uint32_t>(random() % geometry.triangles.size());
    const glm::uvec3 t = geometry.triangles[id];
    float u = number(-0.02f, 1), v = number(-0.02f, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const glm::vec3 at = geometry.positions[t.x] + u * (geometry.positions[t.y] - geometry.positions[t.x]) +
                         v * (geometry.positions[t.z] - geometry.positions[t.x]);
    const glm::vec3 offset = at - view.eye;
    if (offset.z > -1) continue;
    const float scale = view.orthographic ? 1.0f : -1.0f / offset.z;
    const glm::vec2 start = view.orthographic ? glm::vec2(0.0f) : glm::vec2(view.d0);
    places.emplace_back((offset.x * scale - start.x) / view.dx.x, (offset.y * scale - start.y) / view.dy.y);
    ids.push_back(ids.size() % 50 == 0 ? background_id : id);
  }
}

inline void RandomScene::add_factors() {
  const std::size_t count = ids.size();
  masks.resize(lights.size());
  irradiance.resize(lights.size());
  factors.resize(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    for (std::size_t k = 0; k < count && lights[i].area; ++k) irradiance[i].push_back(number(0, 0.4f));
    for (std::size_t k = 0; k < count && !lights[i].area; ++k)
      masks[i].push_back(i == 1 ? static_cast<std::uint8_t>(random()) : random() % 2 == 0 ? 255 : 0);
    if (lights[i].area) factors[i].irradiance = irradiance[i];
    if (!lights[i].area && i != 2) factors[i].mask = masks[i];  // light 2: no mask, all lit
  }
  for (std::size_t k = 0; k < count; ++k) tints.push_back(k % 200 < 100 ? glm::vec3(1.0f) : vector(0, 1));
  coloured.assign(count / shade::TintFactors::run + 1, 1);
  factors[0].tint = factors[5].tint = {tints, coloured};
  for (std::size_t k = 0; k < count; ++k) openness.push_back(number(0, 1));
}

inline std::vector<std::uint32_t> RandomScene::ids_seen(int columns, int rows) const {
  std::vector<std::uint32_t> out(static_cast<std::size_t>(columns * rows), background_id);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double x = static_cast<double>(i % static_cast<std::size_t>(columns)) + 0.5,
                 y = static_cast<double>(i / static_cast<std::size_t>(columns)) + 0.5;
    const glm::dvec3 ray = glm::dvec3(view.d0) + x * glm::dvec3(view.dx) + y * glm::dvec3(view.dy);
    double nearest = 1e30;
    for (std::uint32_t id = 0; id < geometry.triangles.size(); ++id) {
      const glm::uvec3 t = geometry.triangles[id];
      const glm::dvec3 a = glm::dvec3(geometry.positions[t.x]) - glm::dvec3(view.eye);
      const glm::dvec3 e1 = glm::dvec3(geometry.positions[t.y] - geometry.positions[t.x]),
                       e2 = glm::dvec3(geometry.positions[t.z] - geometry.positions[t.x]);
      const glm::dvec3 n = glm::cross(e1, e2);
      const double at = glm::dot(n, a) / glm::dot(n, ray);
      const glm::dvec3 inside = at * ray - a;
      const double u = glm::dot(glm::cross(e2, n), inside) / glm::dot(n, n),
                   v = glm::dot(glm::cross(n, e1), inside) / glm::dot(n, n);
      if (!(at > 0.1 && at < nearest && u >= 0 && v >= 0 && u + v <= 1)) continue;
      nearest = at;
      out[i] = id;
    }
  }
  return out;
}

/// Before rounding to a level: what a picture shows of a channel.
inline float level_of(float linear, float exposure) {
  const float x = std::clamp(exposure * linear, 0.0f, 1.0f);
  return 255.0f * (x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f);
}

}  // namespace tenebra
