// From the bytes of a file to gltf::Asset: container, schema, tinygltf, buffers.
#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "formats/gltf/container.h"
#include "formats/gltf/model.h"
#include "formats/gltf_check/schema.h"
#include "formats/scene_file.h"

namespace tenebra::formats::gltf {
namespace {

constexpr std::array<std::string_view, 18> understood_extensions = {
    "KHR_materials_ior",       "KHR_materials_specular",  "KHR_meshopt_compression",
    "KHR_lights_punctual",     "EXT_lights_area",         "KHR_mesh_quantization",
    "KHR_materials_unlit",     "KHR_node_visibility",     "KHR_materials_emissive_strength",
    "KHR_texture_transform",   "EXT_meshopt_compression", "KHR_draco_mesh_compression",
    "EXT_mesh_gpu_instancing", "KHR_animation_pointer",   "KHR_materials_transmission",
    "EXT_texture_webp",        "KHR_texture_basisu",      "KHR_materials_pbrSpecularGlossiness"};

bool is_understood(std::string_view extension) {
  return std::find(understood_extensions.begin(), understood_extensions.end(), extension) !=
         understood_extensions.end();
}

/// Whether geometry and animation are the same without extension `name`: it is about how surfaces look, or
/// about sound, tools and descriptions.
bool leaves_geometry(std::string_view name) {
  static const std::set<std::string_view> others = {"ADOBE_materials_clearcoat_specular",
                                                    "ADOBE_materials_clearcoat_tint",
                                                    "ADOBE_materials_thin_transparency",
                                                    "AGI_stk_metadata",
                                                    "CESIUM_primitive_outline",
                                                    "EXT_instance_features",
                                                    "EXT_lights_ies",
                                                    "EXT_lights_image_based",
                                                    "EXT_mesh_features",
                                                    "EXT_structural_metadata",
                                                    "FB_geometry_metadata",
                                                    "KHR_audio_emitter",
                                                    "KHR_environment_map",
                                                    "KHR_lights_environment",
                                                    "KHR_node_hoverability",
                                                    "KHR_node_selectability",
                                                    "KHR_technique_webgl",
                                                    "KHR_techniques_webgl",
                                                    "KHR_xmp",
                                                    "KHR_xmp_json_ld",
                                                    "MSFT_packing_normalRoughnessMetallic",
                                                    "MSFT_packing_occlusionRoughnessMetallic",
                                                    "NV_materials_mdl"};
  if (others.contains(name)) return true;
  const std::size_t vendor = name.find('_');
  if (vendor == std::string_view::npos) return false;
  const std::string_view rest = name.substr(vendor + 1);
  return rest.starts_with("materials_") || rest.starts_with("texture_");
}

void check_version(Asset& asset) {
  const std::string& version = asset.model.asset.version;
  const std::string& least = asset.model.asset.minVersion;
  if (version.starts_with("1"))
    refuse("asset.version: found '{}', expected 2.x: gltf-pipeline makes glTF 2.0 of it", version);
  if (version != "2" && !version.starts_with("2."))
    refuse("asset.version: found '{}', expected 2.x", version);
  if (!least.empty() && !least.starts_with("2.")) refuse("asset.minVersion: found '{}', expected 2.x", least);
  if (version != "2.0" || (!least.empty() && least != "2.0"))
    asset.scene.warnings.push_back(
        fmt::format("asset: found version {}; asset.version is read as 2.0.", version));
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

struct BufferSource {
  const std::filesystem::path& folder;
  const GltfContainer& container;
  Asset& asset;

  std::string read(const Value& buffer, std::size_t index, std::uint64_t length) const {
    const std::string place = fmt::format("buffers[{}]", index);
    if (const Value* uri = member(buffer, "uri")) {
      const std::string& text = uri->Get<std::string>();
      if (text.starts_with("data:")) return decode_data_uri(text, place + ".uri");
      const auto path = confine(folder, text, place + ".uri", true, asset.root);
      try {
        std::string bytes = read_scene_file(path, asset.files_read);
        asset.budget.give(8 * bytes.size());
        return bytes;
      } catch (const ImportFailure& failure) {
        refuse("{}.uri '{}': {}", place, text, failure.what());
      }
    }
    if (index == 0 && container.binary) return std::string(*container.binary);
    asset.budget.take(length, 1, place);
    asset.scene.warnings.push_back(fmt::format("{}: found no bytes for it, taken as zeros.", place));
    return std::string(length, '\0');
  }
};

bool is_fallback(const Value& buffer) {
  const Value* extensions = member(buffer, "extensions");
  const Value* meshopt = extensions ? member(*extensions, "EXT_meshopt_compression") : nullptr;
  if (extensions && !meshopt) meshopt = member(*extensions, "KHR_meshopt_compression");
  const Value* fallback = meshopt ? member(*meshopt, "fallback") : nullptr;
  if (!fallback || !fallback->Get<bool>()) return false;
  return has_meshopt() || !member(buffer, "uri");
}

// tinygltf would fetch the buffers itself; here they stay under root "extras" so that it does not.
void load_buffers(const BufferSource& source) {
  const Value* buffers = member(source.asset.model.extras, "buffers");
  if (!buffers) return;
  for (std::size_t i = 0; i < buffers->ArrayLen(); ++i) {
    const Value& buffer = buffers->Get(i);
    const auto length = static_cast<std::uint64_t>(number_or(buffer, "byteLength", 0));
    if (length == 0)
      source.asset.scene.warnings.push_back(
          fmt::format("buffers[{}].byteLength: found 0, expected 1 or more.", i));
    if (is_fallback(buffer)) {  // its views hold compressed copies of what would be in it
      source.asset.buffers.emplace_back();
      continue;
    }
    std::string bytes = source.read(buffer, i, length);
    // What lies in it may be whole all the same: check_accessors tells.
    if (bytes.size() < length)
      source.asset.scene.warnings.push_back(
          fmt::format("buffers[{}].byteLength: found {}, expected at most the {} bytes that are there.", i,
                      length, bytes.size()));
    const Value* uri = member(buffer, "uri");
    if (bytes.size() > length && uri && uri->Get<std::string>().starts_with("data:"))
      source.asset.scene.warnings.push_back(fmt::format(
          "buffers[{}].byteLength: found {}, expected the {} bytes of its uri; the others are not used.", i,
          length, bytes.size()));
    bytes.resize(std::min<std::uint64_t>(bytes.size(), length));
    source.asset.decoded_allowed += 16 * bytes.size();
    source.asset.buffers.push_back(std::move(bytes));
  }
}

void check_extensions(Asset& asset) {
  const Model& model = asset.model;
  auto& warnings = asset.scene.warnings;
  std::set<std::string> unread;
  for (const std::string& name : model.extensionsRequired) {
    if (is_understood(name)) continue;
    if (!leaves_geometry(name))
      refuse(
          "extensionsRequired: found {}, which may change the geometry and is not read; expected only "
          "extensions that are read or that touch looks alone",
          name);
    unread.insert(name);
    warnings.push_back(fmt::format(
        "extensionsRequired: {} is not read; the geometry is whole, but surfaces may look different.", name));
  }
  const auto is_counted = [&](const std::string& name) {  // such content has a sentence of its own
    return std::any_of(asset.scene.unused.begin(), asset.scene.unused.end(),
                       [&](const UnusedContent& content) { return content.name == name; });
  };
  std::string names;
  for (const std::string& name : model.extensionsUsed)
    if (!is_understood(name) && !is_counted(name) && unread.insert(name).second)
      names += (names.empty() ? "" : ", ") + name;
  if (!names.empty()) warnings.push_back(fmt::format("extensionsUsed: {}: not read.", names));
}

/// What the schema's hide_indices_without_view and hide_odd_strides put aside.
void restore_hidden(Model& model) {
  for (auto& view : model.bufferViews)
    if (const Value* stride = member(view.extras, "byteStride"))
      view.byteStride = static_cast<std::size_t>(stride->GetNumberAsInt());
  for (auto& mesh : model.meshes)
    for (auto& primitive : mesh.primitives)
      if (const Value* indices = member(primitive.extras, "indices"))
        primitive.indices = indices->GetNumberAsInt();
}

bool no_file_exists(const std::string&, void*) {
  return false;
}
std::string no_path(const std::string&, void*) {
  return {};
}
bool read_no_file(std::vector<unsigned char>*, std::string*, const std::string&, void*) {
  return false;
}
bool write_no_file(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}
bool load_no_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                   int, void*) {
  return true;
}

}  // namespace

std::string decode_data_uri(const std::string& uri, const std::string& place) {
  static constexpr std::string_view marker = ";base64,";
  const std::size_t start = uri.find(marker);
  if (start == std::string::npos) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) refuse("{}: found no comma, expected data:TYPE,BYTES", place);
    return undo_percent(std::string_view(uri).substr(comma + 1), place);
  }
  if (uri[start - 1] == ';')
    refuse("{}: found '{}', expected data:TYPE;base64,...", place, uri.substr(0, 40));
  std::string_view text = std::string_view(uri).substr(start + marker.size());
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) refuse("{}: found a character outside base64, expected base64", place);
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes += static_cast<char>(bits >> bit_count & 0xFF);
  }
  return bytes;
}

void load_model(const std::filesystem::path& path, std::string_view bytes, Asset& asset) {
  const GltfContainer container = split_gltf(bytes, path.extension() == ".glb");
  check_json_size(container.json);
  asset.scene.warnings = container.warnings;
  const std::string json = check_gltf_schema(container.json, asset.scene.warnings, asset.scene.unused);
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks({no_file_exists, no_path, read_no_file, write_no_file, nullptr});
  reader.SetImageLoader(load_no_image, nullptr);
  std::string error, warning;
  if (!reader.LoadASCIIFromString(&asset.model, &error, &warning, json.data(),
                                  static_cast<unsigned>(json.size()), ""))
    refuse("JSON: found a fault ({}), expected glTF 2.0", error.substr(0, error.find('\n')));
  restore_hidden(asset.model);
  asset.scene.extensions = asset.model.extensionsUsed;
  check_version(asset);
  check_extensions(asset);
  load_buffers({path.parent_path(), container, asset});
  decode_meshopt(asset);
  decode_draco(asset);
}

}  // namespace tenebra::formats::gltf
