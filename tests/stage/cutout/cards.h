// Cards with pictures whose alpha cuts, and what is true of them by the picture alone.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include <tenebra/scene.h>
#include "texture/bilinear.h"

namespace tenebra::testing {

/// A picture by a function of the pixel.
inline TextureImage picture(int width, int height, const std::function<double(int x, int y)>& alpha) {
  TextureImage image{"picture", width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto a = static_cast<std::uint8_t>(std::lround(std::fmin(255, std::fmax(0, 255 * alpha(x, y)))));
      image.rgba.insert(image.rgba.end(), {200, 150, 100, a});
    }
  }
  return image;
}

inline TextureImage checker(int size, int field) {
  return picture(size, size, [=](int x, int y) { return (x / field + y / field) % 2; });
}

/// A pointed oval with a soft edge about two pixels wide, and a stem.
inline TextureImage leaf(int size) {
  return picture(size, size, [=](int x, int y) {
    const double u = (x + 0.5) / size - 0.5, v = (y + 0.5) / size - 0.5;
    const double blade = 0.42 * std::cos(3.1 * v) - 0.14 - std::abs(u) + 0.02 * std::sin(40 * v);
    const double stem = v > 0 ? 0.02 - std::abs(u) : -1.0;
    return 0.5 + std::fmax(blade, stem) * size / 2;
  });
}

inline TextureImage fence(int size) {
  return picture(size, size, [=](int x, int y) {
    const int a = (x + y) % 16, b = (x - y + 16 * size) % 16;
    return a < 3 || b < 3 ? 1 : 0;
  });
}

inline TextureImage noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  return picture(width, height, [&](int, int) { return static_cast<double>(random() % 256) / 255; });
}

/// A square from (0,0) to (1,1) in its node's space, of two triangles; texture coordinates from `low` to
/// `high`.
inline Scene card(TextureImage image, glm::vec2 low = glm::vec2(0.0f), glm::vec2 high = glm::vec2(1.0f)) {
  Scene scene;
  scene.images.push_back(std::move(image));
  Material& material = scene.materials.emplace_back();
  material.name = "card";
  material.alpha_mode = AlphaMode::mask;
  material.base_color_map.image = 0;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.texture_coordinates[0] = {low, {high.x, low.y}, high, {low.x, high.y}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {0, 0};
  scene.nodes.emplace_back().mesh = 0;
  return scene;
}

/// Alpha times the factors, less the cutoff, by the texture's own sampler.
inline double alpha_over(const Scene& scene, glm::vec2 uv) {
  const Material& material = scene.materials[0];
  const glm::vec4 texel = texture::sample_bilinear(scene.images[0], material.base_color_map, uv);
  return static_cast<double>(texel.a) * material.alpha - material.alpha_cutoff;
}

/// Whether alpha passes the cutoff within `pixels` of a place of the texture.
inline bool is_near_line(const Scene& scene, glm::vec2 uv, double pixels) {
  const TextureImage& image = scene.images[0];
  const glm::dmat3x2 transform(scene.materials[0].base_color_map.transform);
  const glm::dmat2 from_place = glm::inverse(glm::dmat2(transform[0], transform[1]));
  const double here = alpha_over(scene, uv);
  if (std::abs(here) < 1e-4) return true;
  for (int ring = 1; ring <= 4; ++ring) {
    for (int i = 0; i < 48; ++i) {
      const double angle = i * 6.283185307 / 48;
      const glm::dvec2 step =
          glm::dvec2(std::cos(angle) / image.width, std::sin(angle) / image.height) * (pixels * ring / 4);
      if ((alpha_over(scene, uv + glm::vec2(from_place * step)) >= 0) != (here >= 0)) return true;
    }
  }
  return false;
}

}  // namespace tenebra::testing
