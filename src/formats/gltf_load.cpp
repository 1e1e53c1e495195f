// From the bytes of a file to gltf::Asset: container, schema, tinygltf, buffers.
#include <fmt/core.h>
#include <algorithm>
#include <set>

#include "formats/gltf_container.h"
#include "formats/gltf_model.h"
#include "formats/gltf_schema.h"
#include "formats/scene_file.h"

namespace tenebra::formats::gltf {
namespace {

const std::set<std::string> understood_extensions = {
    "KHR_lights_punctual",  "EXT_lights_area",     "KHR_mesh_quantization",
    "KHR_materials_unlit",  "KHR_node_visibility", "KHR_materials_emissive_strength",
    "KHR_texture_transform"};

void check_version(Asset& asset) {
  const std::string& version = asset.model.asset.version;
  const std::string& least = asset.model.asset.minVersion;
  if (!version.starts_with("2.")) refuse("asset.version: found '{}', expected 2.x", version);
  if (!least.empty() && !least.starts_with("2.")) refuse("asset.minVersion: found '{}', expected 2.x", least);
  if (version != "2.0" || (!least.empty() && least != "2.0"))
    asset.scene.warnings.push_back(fmt::format("asset: found version {}; read as 2.0.", version));
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

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

struct BufferSource {
  const std::filesystem::path& folder;
  const GltfContainer& container;
  Asset& asset;

  std::string read(const Value& buffer, std::size_t index, std::uint64_t length) const {
    const std::string place = fmt::format("buffers[{}]", index);
    if (const Value* uri = member(buffer, "uri")) {
      const std::string& text = uri->Get<std::string>();
      if (text.starts_with("data:")) return decode_data_uri(text, place + ".uri");
      const auto path = confine(folder, text, place + ".uri", true);
      try {
        std::string bytes = read_scene_file(path);
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

// tinygltf would fetch the buffers itself; here they stay under root "extras" so that it does not.
void load_buffers(const BufferSource& source) {
  const Value* buffers = member(source.asset.model.extras, "buffers");
  if (!buffers) return;
  for (std::size_t i = 0; i < buffers->ArrayLen(); ++i) {
    const Value& buffer = buffers->Get(i);
    const auto length = static_cast<std::uint64_t>(number_or(buffer, "byteLength", 0));
    if (length == 0) refuse("buffers[{}].byteLength: found 0, expected 1 or more", i);
    std::string bytes = source.read(buffer, i, length);
    if (bytes.size() < length)
      refuse("buffers[{}].byteLength: found {}, expected at most the {} bytes that are there", i, length,
             bytes.size());
    bytes.resize(length);
    source.asset.buffers.push_back(std::move(bytes));
  }
}

void check_required_extensions(const Model& model) {
  for (const std::string& name : model.extensionsRequired)
    if (!understood_extensions.contains(name))
      refuse("extensionsRequired: found {}, expected only extensions that Tenebra reads", name);
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

void load_model(const std::filesystem::path& path, std::string_view bytes, Asset& asset) {
  const GltfContainer container = split_gltf(bytes, path.extension() == ".glb");
  check_json_size(container.json);
  const std::string json = check_gltf_schema(container.json, asset.scene.warnings);
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks({no_file_exists, no_path, read_no_file, write_no_file, nullptr});
  reader.SetImageLoader(load_no_image, nullptr);
  std::string error, warning;
  if (!reader.LoadASCIIFromString(&asset.model, &error, &warning, json.data(),
                                  static_cast<unsigned>(json.size()), ""))
    refuse("JSON: found a fault ({}), expected glTF 2.0", error.substr(0, error.find('\n')));
  check_version(asset);
  check_required_extensions(asset.model);
  load_buffers({path.parent_path(), container, asset});
}

}  // namespace tenebra::formats::gltf
