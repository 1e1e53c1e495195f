#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "formats/import_failure.h"
#include "formats/obj/mtl.h"
#include "formats/text_lines.h"

namespace tenebra::formats {
namespace {

TextureMap map_of(const MtlMap* source, const std::string& place, SceneImages& images) {
  TextureMap map;
  if (source == nullptr) return map;
  map.image = images.find(source->picture, place + ", " + source->written);
  if (map.image < 0) return map;
  if (source->clamp) map.wrap_u = map.wrap_v = Wrap::clamp_to_edge;
  // -s and -o scale and move coordinates whose v points up: v' = 1 - (scale * (1 - v) + offset).
  const glm::vec2 scale = source->scale, offset = source->offset;
  map.transform = {glm::vec2(scale.x, 0), glm::vec2(0, scale.y), glm::vec2(offset.x, 1 - scale.y - offset.y)};
  return map;
}

/// Whether the materials are those of MeshLab, OpenMVS and others that write Tr 1 for opaque: to the letter
/// all of them would be invisible.
bool transparency_means_opacity(const std::vector<MtlMaterial>& sources) {
  return !sources.empty() && std::all_of(sources.begin(), sources.end(), [](const MtlMaterial& source) {
    return !source.dissolve && source.transparency == 1.0f;
  });
}

float alpha_of(const MtlMaterial& source) {
  const float alpha = source.dissolve ? *source.dissolve : 1 - source.transparency.value_or(0);
  return std::clamp(alpha, 0.0f, 1.0f);
}

/// Materials with a fault of one kind.
struct Faulty {
  std::string first;  ///< in words
  std::size_t count = 0;

  void add(const std::string& place) {
    if (count++ == 0) first = place;
  }
};

/// Whether two pictures lie on the surface in the same way, so that one can be made of them; where there is
/// only one, they do.
bool placed_alike(const TextureMap& a, const TextureMap& b) {
  return !a || !b || (a.transform == b.transform && a.wrap_u == b.wrap_u);
}

/// map_d: alpha from a picture of its own, which is used where it lies on the surface as map_Kd does.
void read_alpha_map(const MtlMaterial& source, const std::string& place, SceneImages& images,
                    Material& material, Faulty& placed_otherwise) {
  const TextureMap shares = map_of(source.map({"map_d"}), place, images);
  if (!shares) return;
  if (!placed_alike(material.base_color_map, shares)) return placed_otherwise.add(place);
  const int both =
      images.with_alpha(material.base_color_map ? material.base_color_map.image : -1, shares.image);
  if (both < 0) return;
  if (!material.base_color_map) material.base_color_map = shares;
  material.base_color_map.image = both;
  if (material.alpha_mode == AlphaMode::opaque)
    material.alpha_mode = images.cuts_out(both) ? AlphaMode::mask : AlphaMode::blend;
}

/// Pr, Pm and their pictures. A picture takes the place of its number: exporters write the number that it
/// replaces beside it, often 0.
void read_roughness(const MtlMaterial& source, const std::string& place, SceneImages& images,
                    Material& material, Faulty& placed_otherwise) {
  const TextureMap rough = map_of(source.map({"map_pr"}), place, images);
  TextureMap metal = map_of(source.map({"map_pm"}), place, images);
  if (!placed_alike(rough, metal)) {
    placed_otherwise.add(place);
    metal = {};
  }
  if (!source.roughness && !source.metallic && !rough && !metal) return;
  material.model = SurfaceModel::metallic_roughness;
  material.roughness = rough ? 1 : std::clamp(source.roughness.value_or(1), 0.0f, 1.0f);
  material.metallic = metal ? 1 : std::clamp(source.metallic.value_or(0), 0.0f, 1.0f);
  material.metallic_roughness_map = rough ? rough : metal;
  material.metallic_roughness_map.image = images.metallic_roughness(rough.image, metal.image);
}

/// norm holds normals; bump and map_Bump heights, or in many files normals too.
void read_normal_map(const MtlMaterial& source, const std::string& place, SceneImages& images,
                     Material& material) {
  material.normal_map = map_of(source.map({"norm"}), place, images);
  const MtlMap* const bumps = source.map({"map_bump", "bump"});
  if (material.normal_map || bumps == nullptr) return;
  material.normal_map = map_of(bumps, place, images);
  material.normal_map.image = images.normals_of_bumps(material.normal_map.image, bumps->bump);
}

/// Materials of whose pictures one lies otherwise than the one that it belongs to.
struct FaultyMaps {
  Faulty alpha_otherwise, rough_otherwise;
};

Material read_material(const MtlMaterial& source, float alpha, SceneImages& images, FaultyMaps& faulty) {
  constexpr int diffuse_only = 1;  // one of the MTL format's illumination models
  const std::string place = fmt::format("material '{}'", shown(source.name));
  Material material;
  material.name = source.name;
  material.base_color = source.diffuse;
  material.emissive = source.emission;
  material.base_color_map = map_of(source.map({"map_kd"}), place, images);
  const MtlMap* const emissive_map = source.map({"map_ke"});
  if (material.emissive != glm::vec3(0)) material.emissive_map = map_of(emissive_map, place, images);
  // Without its picture the factor alone would shine from all of the surface.
  if (emissive_map != nullptr && !material.emissive_map) material.emissive = glm::vec3(0);
  // Ns 0 is what programs write that have no gloss; as an exponent it would shine from everywhere.
  const float exponent = std::max(source.shininess.value_or(1), 0.0f);
  if (source.illumination != diffuse_only && exponent > 0) material.specular = source.specular;
  material.phong_exponent = exponent > 0 ? exponent : 1;
  read_roughness(source, place, images, material, faulty.rough_otherwise);
  material.alpha = alpha;
  if (material.alpha < 1) material.alpha_mode = AlphaMode::blend;
  if (material.specular != glm::vec3(0)) {
    material.specular_map = map_of(source.map({"map_ks"}), place, images);
    material.exponent_map = map_of(source.map({"map_ns"}), place, images);
  }
  read_alpha_map(source, place, images, material, faulty.alpha_otherwise);
  read_normal_map(source, place, images, material);
  return material;
}

/// What the materials have and nothing here uses.
void name_unused(const std::vector<MtlMaterial>& sources, Scene& scene) {
  std::map<std::string, std::size_t> counts;
  static const std::set<std::string_view> used{"map_kd",   "map_ke", "map_ks", "map_ns", "map_d",
                                               "map_bump", "bump",   "norm",   "map_pr", "map_pm"};
  constexpr std::size_t most_kinds = 20;  // a file of another kind has thousands
  for (const MtlMaterial& source : sources)
    for (const MtlMap& map : source.maps) {
      if (used.contains(map.statement)) continue;
      const std::string name = shown(map.written);
      if (counts.size() < most_kinds || counts.contains(name)) ++counts[name];
    }
  for (const auto& [name, count] : counts) scene.unused.push_back({name, count});
}

void name_faulty(const Faulty& faulty, const char* map, const char* other, Scene& scene) {
  if (faulty.count == 0) return;
  scene.warnings.push_back(fmt::format(
      "{}{}: found {} with other options than {}, expected the same; it is not used.", faulty.first,
      faulty.count > 1 ? fmt::format(" and {} more", faulty.count - 1) : "", map, other));
}

}  // namespace

void add_materials(const std::vector<MtlMaterial>& sources, SceneImages& images, Scene& scene) {
  const bool all_opaque = transparency_means_opacity(sources);
  FaultyMaps faulty;
  for (const MtlMaterial& source : sources)
    scene.materials.push_back(read_material(source, all_opaque ? 1 : alpha_of(source), images, faulty));
  name_faulty(faulty.alpha_otherwise, "map_d", "map_Kd", scene);
  name_faulty(faulty.rough_otherwise, "map_Pm", "map_Pr", scene);
  if (all_opaque)
    scene.warnings.push_back(
        "Every material states Tr 1, with which nothing would be seen: taken as opaque, as MeshLab writes "
        "it.");
  name_unused(sources, scene);
}

std::vector<int> find_materials(const std::vector<MtlMaterial>& materials,
                                const std::vector<std::string>& names) {
  std::unordered_map<std::string_view, int> by_written, by_name;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    by_written.try_emplace(materials[i].written, static_cast<int>(i));
    by_name.try_emplace(materials[i].name, static_cast<int>(i));
  }
  std::vector<int> found;
  for (const std::string& name : names) {
    const auto exact = by_written.find(name), cut = by_name.find(without_comment(name));
    found.push_back(exact != by_written.end() ? exact->second : cut != by_name.end() ? cut->second : -1);
  }
  return found;
}

}  // namespace tenebra::formats
