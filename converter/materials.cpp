#include <assimp/material.h>

#include <algorithm>
#include <cmath>

#include "gltf_writer.h"

namespace tenebra::converter {
namespace {

float number_of(const aiMaterial& source, const char* key, unsigned type, unsigned index, float otherwise) {
  float value = otherwise;
  source.Get(key, type, index, value);
  return std::isfinite(value) ? value : otherwise;
}

Json color_of(const aiMaterial& source, const char* key, unsigned type, unsigned index, float otherwise) {
  aiColor3D color(otherwise, otherwise, otherwise);
  source.Get(key, type, index, color);
  Json written = Json::array();
  for (const float part : {color.r, color.g, color.b})
    written.push_back(std::isfinite(part) ? std::clamp(part, 0.0f, 1.0f) : otherwise);
  return written;
}

float opacity_of(const aiMaterial& source) {
  return std::clamp(number_of(source, AI_MATKEY_OPACITY, 1), 0.0f, 1.0f);
}

}  // namespace

/// The index of the texture of the picture `name`, which may be in the file.
std::size_t GltfWriter::image(const std::string& name) {
  const auto [known, is_new] = image_index_.try_emplace(name, 0);
  if (!is_new) return known->second;
  const aiTexture* const embedded = scene_.GetEmbeddedTexture(name.c_str());
  Json image{{"name", name}};
  if (embedded != nullptr && embedded->mHeight == 0) {
    const std::string_view bytes(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth);
    image["bufferView"] = glb_.add_view(bytes.data(), bytes.size());
    image["mimeType"] = bytes.starts_with("\xFF\xD8") ? "image/jpeg" : "image/png";
  } else {
    image["uri"] = picture_uri(folder_, name);
  }
  return known->second = glb_.add("textures", {{"source", glb_.add("images", std::move(image))}});
}

/// Null where there is none.
Json GltfWriter::texture(const aiMaterial& source, aiTextureType type) {
  aiString name;
  unsigned set = 0;
  if (source.GetTexture(type, 0, &name, nullptr, &set) != aiReturn_SUCCESS || name.length == 0)
    return nullptr;
  const aiTexture* const embedded = scene_.GetEmbeddedTexture(name.C_Str());
  if (embedded != nullptr && embedded->mHeight != 0) {
    leave_out("A picture in the file, stored without a format, is left out.");
    return nullptr;
  }
  return {{"index", image(name.C_Str())}, {"texCoord", std::min(set, 1u)}};
}

/// Phong's highlights, which glTF does not know: in the extras that Tenebra writes itself. Null where there
/// are none. Assimp gives materials without any a colour for them, too, and those of FBX the roughness that
/// Blender makes of the exponent; another roughness is the file's own.
Json GltfWriter::phong(const aiMaterial& source) {
  int shading = aiShadingMode_Gouraud;
  source.Get(AI_MATKEY_SHADING_MODEL, shading);
  const float exponent = number_of(source, AI_MATKEY_SHININESS, 0);
  if ((shading != aiShadingMode_Phong && shading != aiShadingMode_Blinn) || !(exponent > 0)) return nullptr;
  const float as_blender = 1 - std::sqrt(exponent) / 10;
  const float roughness = number_of(source, AI_MATKEY_ROUGHNESS_FACTOR, as_blender);
  constexpr float roundings = 1e-5f;  // of a handful of operations on numbers below 100
  if (std::abs(roughness - as_blender) > roundings || number_of(source, AI_MATKEY_METALLIC_FACTOR, 0) > 0)
    return nullptr;
  const float strength = std::clamp(number_of(source, AI_MATKEY_SHININESS_STRENGTH, 1), 0.0f, 1.0f);
  Json picture = texture(source, aiTextureType_SPECULAR);
  Json color = color_of(source, AI_MATKEY_COLOR_SPECULAR, picture.is_null() ? 0.0f : 1.0f);
  for (Json& part : color) part = part.get<float>() * strength;
  if (color == Json{0.0f, 0.0f, 0.0f}) return nullptr;
  Json written{{"model", "phong"}, {"specular", std::move(color)}, {"phong_exponent", exponent}};
  if (!picture.is_null()) written["specular_texture"] = std::move(picture);
  return written;
}

Json GltfWriter::material(const aiMaterial& source, bool all_clear) {
  Json pbr{{"metallicFactor", std::clamp(number_of(source, AI_MATKEY_METALLIC_FACTOR, 0), 0.0f, 1.0f)},
           {"roughnessFactor", std::clamp(number_of(source, AI_MATKEY_ROUGHNESS_FACTOR, 1), 0.0f, 1.0f)}};
  Json written{{"name", source.GetName().C_Str()}};
  const float opacity = all_clear ? 1 : opacity_of(source);
  Json picture = texture(source, aiTextureType_BASE_COLOR);
  if (picture.is_null()) picture = texture(source, aiTextureType_DIFFUSE);
  pbr["baseColorFactor"] = color_of(source, AI_MATKEY_COLOR_DIFFUSE, picture.is_null() ? 0.6f : 1.0f);
  pbr["baseColorFactor"].push_back(opacity);
  aiString clear;
  const bool cut = source.GetTexture(aiTextureType_OPACITY, 0, &clear) == aiReturn_SUCCESS;
  if (cut) {  // glTF has opacity in the alpha of the colour's picture
    const auto known = image_index_.find(clear.C_Str());
    if (picture.is_null() || known == image_index_.end() || picture["index"] != known->second)
      leave_out(
          "Opacity in a picture apart from that of the colour is left out: put it into the alpha of that.");
  }
  if (!picture.is_null()) pbr["baseColorTexture"] = std::move(picture);
  if (cut || opacity < 1) written["alphaMode"] = opacity < 1 ? "BLEND" : "MASK";
  if (Json normals = texture(source, aiTextureType_NORMALS); !normals.is_null())
    written["normalTexture"] = std::move(normals);
  const Json emission = color_of(source, AI_MATKEY_COLOR_EMISSIVE, 0);
  if (Json shines = texture(source, aiTextureType_EMISSIVE); !shines.is_null()) {
    written["emissiveTexture"] = std::move(shines);
    written["emissiveFactor"] = emission == Json{0.0f, 0.0f, 0.0f} ? Json{1.0f, 1.0f, 1.0f} : emission;
  } else {
    written["emissiveFactor"] = emission;
  }
  written["pbrMetallicRoughness"] = std::move(pbr);
  if (Json shine = phong(source); !shine.is_null()) written["extras"] = std::move(shine);
  return written;
}

void GltfWriter::add_materials() {
  const auto all = [&](auto&& holds) {
    return std::all_of(scene_.mMaterials, scene_.mMaterials + scene_.mNumMaterials, holds);
  };
  // Some programs write opacity the other way round.
  const bool all_clear =
      scene_.mNumMaterials > 0 && all([](const aiMaterial* m) { return opacity_of(*m) == 0; });
  if (all_clear) leave_out("All materials have opacity 0, which is taken for opaque.");
  for (unsigned i = 0; i < scene_.mNumMaterials; ++i)
    glb_.add("materials", material(*scene_.mMaterials[i], all_clear));
}

}  // namespace tenebra::converter
