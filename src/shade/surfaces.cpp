#include "shade/surfaces.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "parallel/parallel.h"
#include "shade/kernels.h"

namespace tenebra::shade {
namespace {

using texture::Content;

/// The material without its textures.
Surface plain_surface(const Kernels& code, const Material& material) {
  auto block = std::make_unique<SampleBlock>();
  block->keeps_gloss = true;
  code.resolve(material, {}, glm::vec3(1.0f), 0, 1, *block);
  const auto at = [](const SampleBlock::Channel(&of)[3]) { return glm::vec3(of[0][0], of[1][0], of[2][0]); };
  return {at(block->base),     at(block->ambient),  at(block->emissive), block->alpha[0],
          at(block->specular), block->roughness[0], block->exponent[0],  block->grazing[0]};
}

/// What identifies a texture: pictures are kept once for each use of their values, with what stands beyond
/// their edges.
struct TextureKey {
  int image;
  Content content;
  Wrap wrap_u, wrap_v;
  auto operator<=>(const TextureKey&) const = default;
};

/// The material's rule for `map`, added if it is new.
int rule_of(const TextureMap& map, std::vector<CoordinateRule>& rules) {
  const auto period = [](Wrap wrap) {
    return wrap == Wrap::clamp_to_edge ? 0.0 : wrap == Wrap::repeat ? 1.0 : 2.0;
  };
  const CoordinateRule wanted{.set = map.uv_set,
                              .transform = glm::dmat3x2(map.transform),
                              .period = {period(map.wrap_u), period(map.wrap_v)},
                              .moves = map.transform != TextureMap{}.transform};
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const CoordinateRule& rule = rules[i];
    if (rule.set == wanted.set && rule.transform == wanted.transform && rule.period == wanted.period)
      return static_cast<int>(i);
  }
  rules.push_back(wanted);
  return static_cast<int>(rules.size()) - 1;
}

}  // namespace

SurfaceTable::SurfaceTable(std::span<const Material> materials) {
  if (materials.empty()) return;
  const Kernels code = kernels(SimdLevel::automatic);
  materials_.assign(materials.begin(), materials.end());
  surfaces_.clear();
  maps_.assign(materials.size(), {});
  for (const Material& m : materials) {
    surfaces_.push_back(plain_surface(code, m));
    any_glossy_ = any_glossy_ || surfaces_.back().is_glossy();
  }
}

void SurfaceTable::set_factors(std::span<const Material> materials) {
  if (materials.empty()) return;
  const Kernels code = kernels(SimdLevel::automatic);
  materials_.assign(materials.begin(), materials.end());
  any_glossy_ = false;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    surfaces_[i] = plain_surface(code, materials[i]);
    any_glossy_ = any_glossy_ || surfaces_[i].is_glossy();
  }
}

SurfaceTable::SurfaceTable(const Scene& scene) : SurfaceTable(std::span(scene.materials)) {
  SurfaceCoordinates coordinates = surface_coordinates(scene);
  coordinates_ = std::move(coordinates.texture_coordinates);
  colors_ = std::move(coordinates.colors);
  for (const std::size_t held : {coordinates_[0].size(), coordinates_[1].size(), colors_.size()})
    coordinates_end_ = std::max(coordinates_end_, held);  // the lists that are not empty are of one size
  if (!scene.materials.empty()) add_textures(scene);
}

void SurfaceTable::add_textures(const Scene& scene) {
  std::map<TextureKey, int> numbers;
  std::vector<TextureKey> wanted;
  const bool curved = scene.transfer == Transfer::srgb;
  const auto use_of = [&](const TextureMap& map, Content content, SurfaceMaps& maps) -> MapUse {
    const auto image = static_cast<std::size_t>(map.image), set = static_cast<std::size_t>(map.uv_set);
    if (!map || image >= scene.images.size() || scene.images[image].rgba.empty()) return {};
    if (set >= coordinates_.size() || coordinates_[set].empty()) return {};
    const TextureKey key{map.image, content, map.wrap_u, map.wrap_v};
    const auto [found, is_new] = numbers.try_emplace(key, static_cast<int>(wanted.size()));
    if (is_new) wanted.push_back(key);
    return {found->second, rule_of(map, maps.rules)};
  };
  const Content color = curved ? Content::srgb_color : Content::display_color;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    SurfaceMaps& maps = maps_[i];
    maps.base = use_of(m.base_color_map, color, maps);
    if (m.emissive != glm::vec3(0.0f)) maps.emissive = use_of(m.emissive_map, color, maps);
    const Content beside_data = curved ? Content::srgb_beside_data : Content::data;
    const bool metallic = m.model == SurfaceModel::metallic_roughness;
    if ((metallic && (m.metallic != 0 || m.roughness != 0)) || m.model == SurfaceModel::phong)
      maps.gloss = use_of(gloss_map(m), Content::data, maps);
    if (m.model != SurfaceModel::unlit) {
      maps.specular = use_of(m.specular_map, beside_data, maps);
      maps.normal = use_of(m.normal_map, Content::normal, maps);
      if (m.occlusion_strength != 0) maps.occlusion = use_of(m.occlusion_map, Content::data, maps);
    }
    if (metallic) maps.specular_share = use_of(m.specular_share_map, beside_data, maps);
    if (m.tinted_transmission && m.transmission > 0)
      maps.transmission = use_of(m.transmission_map, Content::data, maps);
    any_bent_ = any_bent_ || maps.normal;
    any_occluded_ = any_occluded_ || maps.occlusion;
  }
  std::vector<std::optional<texture::MipTexture>> made(wanted.size());
  parallel::parallel_in_order(static_cast<int>(wanted.size()), [&](int i) {
    const TextureKey& key = wanted[static_cast<std::size_t>(i)];
    made[static_cast<std::size_t>(i)].emplace(scene.images[static_cast<std::size_t>(key.image)], key.content,
                                              key.wrap_u, key.wrap_v);
  });
  for (auto& texture : made) textures_.push_back(std::move(*texture));
}

CoordinatePlane SurfaceTable::coordinates(const CoordinateRule& rule, const glm::uvec3& corners) const {
  const std::vector<glm::vec2>& at = coordinates_[static_cast<std::size_t>(rule.set)];
  const auto placed = [&](std::uint32_t vertex) {
    return rule.moves ? rule.transform * glm::dvec3(at[vertex], 1.0) : glm::dvec2(at[vertex]);
  };
  // In double, and less whole periods: far from 0 floats would lose a repeated texture's fractions.
  const glm::dvec2 first = placed(corners.x);
  glm::dvec2 held = first;
  for (int c = 0; c < 2; ++c) {
    const double period = rule.period[c];
    if (period > 0) held[c] -= period * std::floor(first[c] / period);
  }
  return {held, placed(corners.y) - first, placed(corners.z) - first};
}

}  // namespace tenebra::shade
