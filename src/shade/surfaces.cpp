#include "shade/surfaces.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "parallel/parallel.h"

namespace tenebra::shade {
namespace {

using glm::vec3;
using glm::vec4;
using texture::Content;

/// A material's factors times what its textures hold at a place.
struct Inputs {
  vec4 base;
  vec3 emissive, specular;
  float metallic, roughness;
  vec4 pattern{1.0f};  ///< what `base` was multiplied with: colours of vertices and of the base texture
};

Inputs factors_of(const Material& m) {
  return {vec4(m.base_color, m.alpha), m.emissive, m.specular, m.metallic, m.roughness};
}

constexpr float dielectric = 0.04f;  // reflectance at 0 degrees of glTF's surfaces that are no metal

Surface resolved(const Material& m, const Inputs& in) {
  Surface s{.base = vec3(in.base), .emissive = in.emissive};
  s.alpha = m.alpha_mode == AlphaMode::opaque ? 1.0f : in.base.a;
  switch (m.model) {
    case SurfaceModel::phong:
      s.specular = in.specular;
      s.exponent = std::max(m.phong_exponent, 0.0f);
      break;
    case SurfaceModel::metallic_roughness:
      s.specular = glm::mix(vec3(dielectric), s.base, in.metallic);
      s.base *= 1 - in.metallic;
      s.roughness = std::clamp(in.roughness, 0.0f, 1.0f);
      break;
    case SurfaceModel::specular_glossiness:
      s.specular = in.specular;
      s.base *= 1 - std::max({in.specular.x, in.specular.y, in.specular.z});
      s.roughness = std::clamp(in.roughness, 0.0f, 1.0f);
      break;
    case SurfaceModel::unlit:
      s.emissive += s.base;
      s.base = vec3(0.0f);
      return s;
  }
  // A stated ambient reflectance has no texture of its own: it is textured as the base colour is, even where
  // that is black (BART's garden).
  s.ambient = m.ambient.x < 0 ? s.base : m.ambient * vec3(in.pattern);
  return s;
}

}  // namespace

SurfaceTable::SurfaceTable(std::span<const Material> materials) {
  if (materials.empty()) return;
  materials_.assign(materials.begin(), materials.end());
  surfaces_.clear();
  maps_.assign(materials.size(), {});
  for (const Material& m : materials) {
    surfaces_.push_back(resolved(m, factors_of(m)));
    any_glossy_ = any_glossy_ || surfaces_.back().is_glossy();
  }
}

SurfaceTable::SurfaceTable(const Scene& scene) : SurfaceTable(std::span(scene.materials)) {
  SurfaceCoordinates coordinates = surface_coordinates(scene);
  coordinates_ = std::move(coordinates.texture_coordinates);
  colors_ = std::move(coordinates.colors);
  if (!scene.materials.empty()) add_textures(scene);
}

void SurfaceTable::add_textures(const Scene& scene) {
  std::map<std::pair<int, Content>, int> numbers;
  std::vector<std::pair<int, Content>> wanted;
  const bool curved = scene.transfer == Transfer::srgb;
  const auto number_of = [&](const TextureMap& map, Content content) {
    const auto image = static_cast<std::size_t>(map.image), set = static_cast<std::size_t>(map.uv_set);
    if (!map || image >= scene.images.size() || scene.images[image].rgba.empty()) return -1;
    if (set >= coordinates_.size() || coordinates_[set].empty()) return -1;
    const auto [found, is_new] = numbers.try_emplace({map.image, content}, static_cast<int>(wanted.size()));
    if (is_new) wanted.emplace_back(map.image, content);
    return found->second;
  };
  const Content color = curved ? Content::srgb_color : Content::display_color;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    maps_[i] = {.base = number_of(m.base_color_map, color), .emissive = number_of(m.emissive_map, color)};
    if (m.model == SurfaceModel::metallic_roughness)
      maps_[i].metallic_roughness = number_of(m.metallic_roughness_map, Content::data);
    if (m.model == SurfaceModel::specular_glossiness)
      maps_[i].specular = number_of(m.specular_map, curved ? Content::srgb_beside_data : Content::data);
  }
  std::vector<std::optional<texture::MipTexture>> made(wanted.size());
  parallel::parallel_in_order(static_cast<int>(wanted.size()), [&](int i) {
    const auto [image, content] = wanted[static_cast<std::size_t>(i)];
    made[static_cast<std::size_t>(i)].emplace(scene.images[static_cast<std::size_t>(image)], content);
  });
  for (auto& texture : made) textures_.push_back(std::move(*texture));
}

vec4 SurfaceTable::read(int texture, const TextureMap& map, const glm::uvec3& corners,
                        const SurfacePlace& place) const {
  const std::vector<glm::vec2>& at = coordinates_[static_cast<std::size_t>(map.uv_set)];
  if (std::max({corners.x, corners.y, corners.z}) >= at.size()) return vec4(1.0f);
  const glm::vec2 origin = at[corners.x], second = at[corners.y] - origin, third = at[corners.z] - origin;
  const auto along = [&](const glm::vec2& w) { return w.x * second + w.y * third; };
  return textures_[static_cast<std::size_t>(texture)].sample(map, origin + along(place.weights),
                                                             {along(place.by_x), along(place.by_y)});
}

Surface SurfaceTable::at(std::size_t material, const glm::uvec3& corners, const SurfacePlace& place) const {
  const std::size_t index = held(material);
  const Material& m = materials_[index];
  const SurfaceMaps& maps = maps_[index];
  Inputs in = factors_of(m);
  if (const auto most = std::max({corners.x, corners.y, corners.z}); most < colors_.size()) {
    const float first = 1 - place.weights.x - place.weights.y;
    in.pattern = first * colors_[corners.x] + place.weights.x * colors_[corners.y] +
                 place.weights.y * colors_[corners.z];
  }
  if (maps.base >= 0) in.pattern *= read(maps.base, m.base_color_map, corners, place);
  in.base *= in.pattern;
  if (maps.emissive >= 0) in.emissive *= vec3(read(maps.emissive, m.emissive_map, corners, place));
  if (maps.metallic_roughness >= 0) {
    const vec4 value = read(maps.metallic_roughness, m.metallic_roughness_map, corners, place);
    in.roughness *= value.g;
    in.metallic *= value.b;
  }
  if (maps.specular >= 0) {
    const vec4 value = read(maps.specular, m.specular_map, corners, place);
    in.specular *= vec3(value);
    in.roughness = 1 - (1 - in.roughness) * value.a;
  }
  return resolved(m, in);
}

}  // namespace tenebra::shade
