// Hand-made frames, every raster pass on both kinds of context, and a debug context that must stay silent.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "gl/context.h"
#include "raster/composite.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"
#include "raster/light_buffer.h"
#include "support/contexts.h"

namespace tenebra {

constexpr std::uint32_t background_id = 0xffffffffu;

/// Rays of a camera at `eye` that looks along -Z, `dx` one unit to the right a pixel at distance `focal_px`.
inline ViewRays forward_view(glm::vec3 eye, float focal_px, int width, int height, float near_m = 0.1f) {
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  return {.eye = eye,
          .d0 = {-0.5f * w / focal_px, 0.5f * h / focal_px, -1.0f},
          .dx = {1.0f / focal_px, 0, 0},
          .dy = {0, -1.0f / focal_px, 0},
          .orthographic = false,
          .near_m = near_m};
}

/// The same without perspective: `pixel_m` metres a pixel.
inline ViewRays orthographic_view(glm::vec3 eye, float pixel_m, int width, int height, float near_m = 0.1f) {
  const glm::vec3 corner = eye + glm::vec3(-0.5f * static_cast<float>(width) * pixel_m,
                                           0.5f * static_cast<float>(height) * pixel_m, 0.0f);
  return {.eye = corner,
          .d0 = {0, 0, -2.0f},
          .dx = {pixel_m, 0, 0},
          .dy = {0, -pixel_m, 0},
          .orthographic = true,
          .near_m = near_m};
}

inline void add_triangle(FrameGeometry& g, glm::vec3 a, glm::vec3 b, glm::vec3 c, std::uint32_t material = 0,
                         glm::vec3 normal = glm::vec3(0.0f)) {
  const auto first = static_cast<std::uint32_t>(g.positions.size());
  for (const glm::vec3& p : {a, b, c}) {
    g.positions.push_back(p);
    g.normals.push_back(normal);
  }
  g.triangles.emplace_back(first, first + 1, first + 2);
  g.materials.push_back(material);
  g.casts_shadow.push_back(1);
}

inline Light make_light(LightType type, float intensity = 1.0f, Falloff falloff = Falloff::inverse_square) {
  Light light;
  light.type = type;
  light.intensity = intensity;
  light.falloff = falloff;
  return light;
}

inline Material make_material(glm::vec3 base_color, glm::vec3 ambient = glm::vec3(-1.0f),
                              glm::vec3 emissive = glm::vec3(0.0f)) {
  Material material;
  material.base_color = base_color;
  material.ambient = ambient;
  material.emissive = emissive;
  return material;
}

/// Triangles of all sizes and directions in the cube of half side `size` around `centre`.
inline FrameGeometry random_soup(int count, glm::vec3 centre, float size, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<float>(random()) / 4294967296.0f * 2.0f - 1.0f; };
  const auto vector = [&] { return glm::vec3(uniform(), uniform(), uniform()); };
  FrameGeometry g;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 middle = centre + size * vector();
    const float extent = size * std::pow(10.0f, uniform() - 0.5f);
    add_triangle(g, middle + extent * vector(), middle + extent * vector(), middle + extent * vector());
  }
  return g;
}

class RasterTest : public ::testing::TestWithParam<gl::ContextKind> {
protected:
  void SetUp() override {
    TENEBRA_NEEDS_CONTEXT(GetParam());
    auto created = gl::Context::create(GetParam(), {.debug = true});
    ASSERT_TRUE(created) << created.error().message;
    context_.emplace(std::move(*created));
    auto gbuffer_pass = raster::GBufferPass::create();
    auto light_pass = raster::LightPass::create();
    auto compositor = raster::Compositor::create();
    ASSERT_TRUE(gbuffer_pass) << gbuffer_pass.error().message;
    ASSERT_TRUE(light_pass) << light_pass.error().message;
    ASSERT_TRUE(compositor) << compositor.error().message;
    passes_.emplace(
        Passes{std::move(*gbuffer_pass), std::move(*light_pass), std::move(*compositor), {}, {}, {}});
  }
  void TearDown() override {
    passes_.reset();
    if (!context_) return;
    for (const std::string& complaint : context_->take_debug_messages()) ADD_FAILURE() << complaint;
  }

  struct Passes {
    raster::GBufferPass gbuffer_pass;
    raster::LightPass light_pass;
    raster::Compositor compositor;
    raster::GeometryBuffers geometry;
    raster::GBuffer gbuffer;
    raster::LightBuffer light_buffer;
  };
  Passes& passes() { return *passes_; }
  gl::Context& context() { return *context_; }

  /// Draws the G-buffer of `frame` and reads its ids and depths.
  void draw(const FrameGeometry& frame, const ViewRays& view, int width, int height,
            const std::vector<Material>& materials = {Material{}}) {
    ASSERT_TRUE(passes().geometry.upload_materials(materials));
    ASSERT_TRUE(passes().geometry.upload(frame));
    const auto drawn = passes().gbuffer_pass.draw(view, passes().geometry, width, height, passes().gbuffer);
    ASSERT_TRUE(drawn) << drawn.error().message;
    raster::read_triangle_ids(passes().gbuffer, ids);
    raster::read_depth(passes().gbuffer, depth);
  }

  std::vector<std::uint32_t> ids;
  std::vector<float> depth;

private:
  std::optional<gl::Context> context_;
  std::optional<Passes> passes_;
};

#define TENEBRA_BOTH_CONTEXTS(suite)                                             \
  INSTANTIATE_TEST_SUITE_P(                                                      \
      , suite, ::testing::Values(gl::ContextKind::egl, gl::ContextKind::osmesa), \
      [](const auto& kind) { return kind.param == gl::ContextKind::egl ? "egl" : "osmesa"; })

}  // namespace tenebra
