// Materials of a GLB. Whatever glTF cannot express is stored in `extras` for import_gltf, and as near as glTF
// comes for other programs.
#include <fmt/core.h>

#include "formats/glb/writer.h"
#include "math/srgb.h"

namespace tenebra::formats {
namespace {

/// sRGB's curve undone: display values as other programs will show them.
glm::vec3 to_linear(const glm::vec3& shown) {
  return {math::linear_of_srgb(shown.x), math::linear_of_srgb(shown.y), math::linear_of_srgb(shown.z)};
}

/// The roughness whose highlight is about as wide as Phong's.
float roughness_of(const Material& material) {
  if (material.model != SurfaceModel::phong) return material.roughness;
  if (material.specular == glm::vec3(0)) return 1;
  return std::sqrt(std::sqrt(2 / (material.phong_exponent + 2)));
}

GlbJson color_with_alpha(const glm::vec3& color, float alpha) {
  return GlbJson::array({color.x, color.y, color.z, alpha});
}

bool is_untinted(const Material& material) {
  return material.transmission > 0 && !material.tinted_transmission;
}

}  // namespace

void GlbWriter::write_reflection(const Material& source, GlbJson& material) {
  const glm::vec3 cut = glm::clamp(source.base_color, 0.0f, 1.0f);
  const bool display = scene_.transfer == Transfer::display;
  const GlbJson color = color_with_alpha(display ? to_linear(cut) : cut, source.alpha);
  GlbJson& pbr = material["pbrMetallicRoughness"];
  pbr = {{"baseColorFactor", color}, {"metallicFactor", source.metallic}};
  if (const float roughness = roughness_of(source); roughness != 1) pbr["roughnessFactor"] = roughness;
  write_map(source.base_color_map, "baseColorTexture", pbr);
  write_map(source.metallic_roughness_map, "metallicRoughnessTexture", pbr);
  if (display || cut != source.base_color) material["extras"]["base_color"] = to_json(source.base_color);
  if (source.model == SurfaceModel::unlit) {
    material["extensions"]["KHR_materials_unlit"] = GlbJson::object();
    use("KHR_materials_unlit");
  } else if (source.model == SurfaceModel::specular_glossiness) {
    GlbJson& gloss = material["extensions"]["KHR_materials_pbrSpecularGlossiness"];
    gloss = {{"diffuseFactor", color},
             {"specularFactor", to_json(glm::clamp(source.specular, 0.0f, 1.0f))},
             {"glossinessFactor", 1 - double{source.roughness}}};
    write_map(source.base_color_map, "diffuseTexture", gloss);
    write_map(source.specular_map, "specularGlossinessTexture", gloss);
    use("KHR_materials_pbrSpecularGlossiness");
  } else if (source.model == SurfaceModel::phong) {
    GlbJson& extras = material["extras"];
    extras["model"] = "phong";
    if (source.specular != glm::vec3(0)) extras["specular"] = to_json(source.specular);
    if (source.phong_exponent != 1) extras["phong_exponent"] = source.phong_exponent;
    write_map(source.specular_map, "specular_texture", extras);
    write_map(source.exponent_map, "phong_exponent_texture", extras);
  }
}

void GlbWriter::write_emission(const Material& source, GlbJson& material) {
  if (source.emissive == glm::vec3(0)) return;
  const float strength = peak_of(source.emissive);
  material["emissiveFactor"] = to_json(source.emissive / strength);
  write_map(source.emissive_map, "emissiveTexture", material);
  if (strength == 1) return;
  material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
  material["extras"]["emissive"] = to_json(source.emissive);  // free of the division's rounding
  use("KHR_materials_emissive_strength");
}

void GlbWriter::write_dielectric(const Material& source, GlbJson& material) {
  const bool plain = source.dielectric == Material{}.dielectric && source.specular_share == 1 &&
                     !source.specular_map && !source.specular_share_map;
  if (source.model != SurfaceModel::metallic_roughness || plain) return;
  GlbJson& written = material["extensions"]["KHR_materials_specular"];
  written["specularFactor"] = source.specular_share;
  const glm::dvec3 color = glm::dvec3(source.dielectric) / double{Material{}.dielectric.x};
  written["specularColorFactor"] = {color.x, color.y, color.z};
  write_map(source.specular_share_map, "specularTexture", written);
  write_map(source.specular_map, "specularColorTexture", written);
  use("KHR_materials_specular");
}

void GlbWriter::write_relief(const Material& source, GlbJson& material) {
  write_map(source.normal_map, "normalTexture", material);
  if (source.normal_map && source.normal_scale != 1) material["normalTexture"]["scale"] = source.normal_scale;
  write_map(source.occlusion_map, "occlusionTexture", material);
  if (source.occlusion_map && source.occlusion_strength != 1)
    material["occlusionTexture"]["strength"] = source.occlusion_strength;
}

void GlbWriter::write_transmission(const Material& source, GlbJson& material) {
  if (source.transmission <= 0) return;
  GlbJson& written = material["extensions"]["KHR_materials_transmission"];
  written["transmissionFactor"] = source.transmission;
  write_map(source.transmission_map, "transmissionTexture", written);
  use("KHR_materials_transmission");
  if (is_untinted(source)) material["extras"]["transmission"] = source.transmission;
}

GlbJson GlbWriter::write_material(const Material& source) {
  GlbJson material = {{"name", source.name}};
  write_reflection(source, material);
  write_dielectric(source, material);
  write_relief(source, material);
  write_emission(source, material);
  write_transmission(source, material);
  if (source.alpha_mode == AlphaMode::mask) {
    material["alphaMode"] = "MASK";
    material["alphaCutoff"] = source.alpha_cutoff;
  } else if (source.alpha_mode == AlphaMode::blend) {
    material["alphaMode"] = "BLEND";
  }
  if (source.double_sided) material["doubleSided"] = true;
  if (!source.casts_shadow) material["extras"]["casts_shadow"] = false;
  if (source.ambient.x >= 0) material["extras"]["ambient"] = to_json(source.ambient);
  return material;
}

/// One sentence for each thing that glTF cannot hold, with the number of materials.
void GlbWriter::name_what_others_miss() {
  std::size_t bright = 0, glossy = 0, untinted = 0;
  for (const Material& source : scene_.materials) {
    bright += glm::clamp(source.base_color, 0.0f, 1.0f) != source.base_color;
    glossy += source.model == SurfaceModel::phong && source.specular != glm::vec3(0);
    untinted += is_untinted(source);
  }
  if (bright > 0)
    losses.push_back(fmt::format(
        "{} materials reflect more than 1 or less than 0: other programs see them cut to that.", bright));
  if (glossy > 0)
    losses.push_back(fmt::format(
        "{} materials have Phong's highlights: other programs see a roughness of about their width.",
        glossy));
  if (untinted > 0)
    losses.push_back(fmt::format(
        "{} materials let light through untinted: other programs tint it with their colour.", untinted));
  if (skewed_ > 0)
    losses.push_back(fmt::format("{} textures are skewed: glTF can only turn and scale them.", skewed_));
  if (scene_.transfer == Transfer::display)
    losses.push_back(
        "The colours are display values: other programs see them made linear, and light them otherwise.");
}

void GlbWriter::write_materials() {
  for (const Material& source : scene_.materials) {
    GlbJson written = write_material(source);
    root_["materials"].push_back(std::move(written));
  }
  name_what_others_miss();
}

}  // namespace tenebra::formats
