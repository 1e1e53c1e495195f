// Hand-made frames: views along -Z, single triangles, lights and materials.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>

#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>

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

/// Such triangles before a camera at the origin that looks along -z, every fifth of them see-through.
inline FrameGeometry mixed_soup(int count) {
  FrameGeometry g = random_soup(count, {0, 0, -6}, 3.0f, 77);
  g.see_through.assign(g.triangles.size(), 0);
  for (std::size_t i = 0; i < g.triangles.size(); i += 5) g.see_through[i] = 1;
  return g;
}

}  // namespace tenebra
