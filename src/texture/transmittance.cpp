#include "texture/transmittance.h"

#include <algorithm>

#include "math/srgb.h"
#include "texture/bilinear.h"

namespace tenebra::texture {
namespace {

glm::vec4 decoded(glm::vec4 stored, Transfer transfer) {
  if (transfer == Transfer::display) return stored;
  return {math::linear_of_srgb(stored.x), math::linear_of_srgb(stored.y), math::linear_of_srgb(stored.z),
          stored.w};
}

/// The picture of `map`; null: there is none.
const TextureImage* image_of(const Scene& scene, const TextureMap& map) {
  if (map.image < 0 || static_cast<std::size_t>(map.image) >= scene.images.size()) return nullptr;
  const TextureImage& image = scene.images[static_cast<std::size_t>(map.image)];
  const auto pixels = static_cast<std::size_t>(std::max(image.width, 0)) *
                      static_cast<std::size_t>(std::max(image.height, 0));
  return pixels > 0 && image.rgba.size() >= 4 * pixels ? &image : nullptr;
}

/// Where image_of is not null.
glm::vec4 sample(const Scene& scene, const TextureMap& map, const glm::vec2 uv[2]) {
  return sample_bilinear(*image_of(scene, map), map, uv[map.uv_set == 1 ? 1 : 0]);
}

glm::vec4 mean_of(const TextureImage& image) {
  glm::dvec4 sum(0.0);
  const std::size_t pixels = image.rgba.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* p = &image.rgba[4 * i];
    sum += glm::dvec4(p[0], p[1], p[2], p[3]);
  }
  return glm::vec4(sum / (255.0 * static_cast<double>(pixels)));
}

/// 0 to 1; 0 for what is no number.
float share(float value) {
  return value > 0 ? std::min(value, 1.0f) : 0.0f;
}

}  // namespace

glm::vec3 transmittance(const Material& material, const glm::vec4& base, float transmission,
                        const glm::vec4& vertex) {
  const bool blends = material.alpha_mode == AlphaMode::blend;
  const float a = blends ? share(material.alpha * base.w * vertex.w) : 1.0f;
  const float t = share(material.transmission * transmission);
  glm::vec3 passed(0.0f);
  for (int c = 0; c < 3; ++c) {
    const float tint =
        material.tinted_transmission ? share(material.base_color[c] * base[c] * vertex[c]) : 1.0f;
    passed[c] = share((1 - a) + a * t * tint);
  }
  return passed;
}

bool uses_vertex_colors(const Material& material) {
  return material.alpha_mode == AlphaMode::blend ||
         (material.tinted_transmission && material.transmission > 0);
}

bool uses_base_map(const Scene& scene, const Material& material) {
  return uses_vertex_colors(material) && image_of(scene, material.base_color_map) != nullptr;
}

bool uses_transmission_map(const Scene& scene, const Material& material) {
  return material.transmission > 0 && image_of(scene, material.transmission_map) != nullptr;
}

float shown_share(const Scene& scene, const Material& material, const glm::vec2 uv[2],
                  const glm::vec4& vertex) {
  if (material.alpha_mode != AlphaMode::blend) return 1;
  const float alpha = uses_base_map(scene, material) ? sample(scene, material.base_color_map, uv).w : 1.0f;
  return share(material.alpha * alpha * vertex.w);
}

glm::vec3 transmittance_at(const Scene& scene, const Material& material, const glm::vec2 uv[2],
                           const glm::vec4& vertex) {
  glm::vec4 base(1.0f);
  float transmission = 1;
  if (uses_base_map(scene, material))
    base = decoded(sample(scene, material.base_color_map, uv), scene.transfer);
  if (uses_transmission_map(scene, material)) transmission = sample(scene, material.transmission_map, uv).x;
  return transmittance(material, base, transmission, vertex);
}

glm::vec3 mean_transmittance(const Scene& scene, const Material& material) {
  glm::vec4 base(1.0f);
  float transmission = 1;
  if (uses_base_map(scene, material))
    base = decoded(mean_of(*image_of(scene, material.base_color_map)), scene.transfer);
  if (uses_transmission_map(scene, material))
    transmission = mean_of(*image_of(scene, material.transmission_map)).x;
  return transmittance(material, base, transmission, glm::vec4(1.0f));
}

}  // namespace tenebra::texture
