// Materials of a glTF file: metallic-roughness, its extensions, and what export_glb wrote into extras.
#include <fmt/core.h>
#include <algorithm>

#include "formats/gltf/textures.h"

namespace tenebra::formats::gltf {
namespace {

struct MaterialReader {
  const tinygltf::Material& source;
  std::string place;
  Textures& textures;
  std::vector<std::string>& warnings;
  Material material = default_material();

  /// `value` cut to 0 to 1, with a warning.
  float share(double value, std::string_view name) {
    const double cut = std::clamp(value, 0.0, 1.0);
    if (cut != value)
      warnings.push_back(
          fmt::format("{}.{}: found {}, expected 0 to 1; {} is used.", place, name, value, cut));
    return static_cast<float>(cut);
  }

  glm::vec3 color(const std::vector<double>& factor, const char* name) {
    return factor.size() < 3
               ? glm::vec3(1)
               : glm::vec3(share(factor[0], name), share(factor[1], name), share(factor[2], name));
  }

  static std::vector<double> numbers(const Value& value, const char* name) {
    std::vector<double> list;
    const Value* found = member(value, name);
    for (std::size_t i = 0; found && i < found->ArrayLen(); ++i)
      list.push_back(found->Get(static_cast<int>(i)).GetNumberAsDouble());
    return list;
  }

  const Value* extension(const char* name) const {
    const auto found = source.extensions.find(name);
    return found == source.extensions.end() ? nullptr : &found->second;
  }

  void read_base(const std::vector<double>& factor, const char* name) {
    material.base_color = color(factor, name);
    if (factor.size() == 4) material.alpha = share(factor[3], name);
  }

  void read_metallic_roughness() {
    const auto& pbr = source.pbrMetallicRoughness;
    read_base(pbr.baseColorFactor, "pbrMetallicRoughness.baseColorFactor");
    material.base_color_map =
        textures.map(pbr.baseColorTexture, place + ".pbrMetallicRoughness.baseColorTexture");
    if (material.model == SurfaceModel::unlit) return;
    material.metallic = share(pbr.metallicFactor, "pbrMetallicRoughness.metallicFactor");
    material.roughness = share(pbr.roughnessFactor, "pbrMetallicRoughness.roughnessFactor");
    material.metallic_roughness_map =
        textures.map(pbr.metallicRoughnessTexture, place + ".pbrMetallicRoughness.metallicRoughnessTexture");
    read_dielectric();
  }

  void read_specular_glossiness(const Value& value) {
    const std::string here = place + ".extensions.KHR_materials_pbrSpecularGlossiness";
    material.model = SurfaceModel::specular_glossiness;
    material.metallic = 0;
    read_base(numbers(value, "diffuseFactor"),
              "extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor");
    material.specular = color(numbers(value, "specularFactor"),
                              "extensions.KHR_materials_pbrSpecularGlossiness.specularFactor");
    material.roughness = 1 - share(number_or(value, "glossinessFactor", 1),
                                   "extensions.KHR_materials_pbrSpecularGlossiness.glossinessFactor");
    material.base_color_map = textures.map(value, "diffuseTexture", here);
    material.specular_map = textures.map(value, "specularGlossinessTexture", here);
  }

  /// Reflectance of what is no metal: KHR_materials_ior and KHR_materials_specular.
  void read_dielectric() {
    if (const Value* value = extension("KHR_materials_ior")) {
      double ior = number_or(*value, "ior", 1.5);
      if (ior != 0 && !(ior >= 1)) {  // 0: all is reflected
        warnings.push_back(fmt::format(
            "{}.extensions.KHR_materials_ior.ior: found {}, expected 0 or at least 1; 1.5 is used.", place,
            ior));
        ior = 1.5;
      }
      const double root = (ior - 1) / (ior + 1);
      material.dielectric = glm::vec3(static_cast<float>(root * root));
    }
    const Value* value = extension("KHR_materials_specular");
    if (!value) return;
    const std::string here = place + ".extensions.KHR_materials_specular";
    glm::vec3 color(1);
    read_color(*value, "specularColorFactor", color);
    material.dielectric *= glm::max(color, glm::vec3(0));
    material.specular_share =
        share(number_or(*value, "specularFactor", 1), "extensions.KHR_materials_specular.specularFactor");
    material.specular_map = textures.map(*value, "specularColorTexture", here);
    material.specular_share_map = textures.map(*value, "specularTexture", here);
  }

  /// What bends normals and dims ambient light.
  void read_relief() {
    material.normal_map = textures.map(source.normalTexture, place + ".normalTexture");
    material.normal_scale = static_cast<float>(source.normalTexture.scale);
    material.occlusion_map = textures.map(source.occlusionTexture, place + ".occlusionTexture");
    material.occlusion_strength = share(source.occlusionTexture.strength, "occlusionTexture.strength");
  }

  void read_emission() {
    if (source.emissiveFactor.size() == 3)
      material.emissive = {source.emissiveFactor[0], source.emissiveFactor[1], source.emissiveFactor[2]};
    material.emissive = glm::max(material.emissive, glm::vec3(0));
    if (const Value* strength = extension("KHR_materials_emissive_strength"))
      material.emissive *= static_cast<float>(std::max(number_or(*strength, "emissiveStrength", 1), 0.0));
    read_color(source.extras, "emissive", material.emissive);
    if (material.emissive == glm::vec3(0)) return;
    material.emissive_map = textures.map(source.emissiveTexture, place + ".emissiveTexture");
    if (source.emissiveTexture.index < 0 || material.emissive_map) return;
    // Such pictures are black but for a few places; the factor alone would shine from all of the surface.
    material.emissive = glm::vec3(0);
    warnings.push_back(
        fmt::format("{}.emissiveTexture: without its picture the surface does not shine.", place));
  }

  void read_alpha() {
    if (source.alphaMode == "MASK")
      material.alpha_mode = AlphaMode::mask;
    else if (source.alphaMode == "BLEND")
      material.alpha_mode = AlphaMode::blend;
    else if (source.alphaMode != "OPAQUE")
      warnings.push_back(
          fmt::format("{}.alphaMode: found '{}', expected OPAQUE, MASK or BLEND; taken as OPAQUE.", place,
                      source.alphaMode.substr(0, 40)));
    material.alpha_cutoff = static_cast<float>(std::max(source.alphaCutoff, 0.0));
    material.double_sided = source.doubleSided;
  }

  void read_transmission() {
    const Value* value = extension("KHR_materials_transmission");
    if (!value) return;
    material.transmission = share(number_or(*value, "transmissionFactor", 0),
                                  "extensions.KHR_materials_transmission.transmissionFactor");
    material.tinted_transmission = true;
    if (material.transmission > 0)
      material.transmission_map =
          textures.map(*value, "transmissionTexture", place + ".extensions.KHR_materials_transmission");
  }

  /// What export_glb writes of materials that glTF cannot say.
  void read_extras() {
    const Value& extras = source.extras;
    material.casts_shadow = !says_no_shadow(extras);
    read_color(extras, "ambient", material.ambient);
    read_color(extras, "base_color", material.base_color);
    if (says(extras, "model", "phong")) {
      material.model = SurfaceModel::phong;
      material.metallic = 0;
      material.roughness = 1;
      read_color(extras, "specular", material.specular);
      material.phong_exponent = static_cast<float>(std::max(number_or(extras, "phong_exponent", 1), 0.0));
      material.specular_map = textures.map(extras, "specular_texture", place + ".extras");
      material.exponent_map = textures.map(extras, "phong_exponent_texture", place + ".extras");
    }
    if (member(extras, "transmission")) {
      material.transmission = static_cast<float>(std::clamp(number_or(extras, "transmission", 0), 0.0, 1.0));
      material.tinted_transmission = false;
    }
  }

  Material read() {
    material.name = source.name;
    if (extension("KHR_materials_unlit")) material.model = SurfaceModel::unlit;
    const Value* glossiness = extension("KHR_materials_pbrSpecularGlossiness");
    if (glossiness && material.model != SurfaceModel::unlit)
      read_specular_glossiness(*glossiness);
    else
      read_metallic_roughness();
    if (material.model != SurfaceModel::unlit) read_relief();
    read_emission();
    read_alpha();
    read_transmission();
    read_extras();
    return std::move(material);
  }
};

}  // namespace

Material default_material() {
  Material material;
  material.base_color = glm::vec3(1);
  material.model = SurfaceModel::metallic_roughness;
  material.metallic = 1;
  material.double_sided = false;
  return material;
}

void build_materials(Asset& asset, const std::filesystem::path& folder, const ImportOptions& options) {
  Textures textures(asset, folder, SceneImages(asset.scene, folder, options));
  for (std::size_t i = 0; i < asset.model.materials.size(); ++i) {
    MaterialReader reader{asset.model.materials[i], fmt::format("materials[{}]", i), textures,
                          asset.scene.warnings};
    asset.scene.materials.push_back(reader.read());
  }
}

}  // namespace tenebra::formats::gltf
