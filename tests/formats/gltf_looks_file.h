// A small glTF file of one triangle, for tests of what a file says of surfaces.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/import_scene.h"
#include "pictures.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {

using Json = nlohmann::json;

inline std::string base64(const std::string& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

inline Json data_uri(const std::string& bytes, const std::string& kind = "image/png") {
  return {{"uri", "data:" + kind + ";base64," + base64(bytes)}};
}

/// Names of all extensions in `value`.
inline void collect_extensions(const Json& value, std::set<std::string>& names) {
  if (!value.is_structured()) return;
  for (const auto& [key, child] : value.items()) {
    if (key == "extensions" && child.is_object())
      for (const auto& [name, unused] : child.items()) names.insert(name);
    collect_extensions(child, names);
  }
}

/// A triangle with one material, whose parts tests change before they import it.
struct LooksFile {
  Json root = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"mesh", 0}}}},
               {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 0}}}}}}},
               {"materials", {Json::object()}}};
  std::string bytes;
  testing::TemporaryFolder folder;

  LooksFile() {
    const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::size_t position = accessor(corners.data(), 36, 5126, "VEC3");
    root["accessors"][position]["min"] = {0, 0, 0};
    root["accessors"][position]["max"] = {1, 1, 0};
    for (const char* set : {"TEXCOORD_0", "TEXCOORD_1"})
      attributes()[set] = accessor(corners.data(), 24, 5126, "VEC2");
  }

  Json& material() { return root["materials"][0]; }
  Json& attributes() { return root["meshes"][0]["primitives"][0]["attributes"]; }

  std::size_t view(const std::string& data) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
    bytes += data;
    return root["bufferViews"].size() - 1;
  }

  /// Three elements of the type.
  std::size_t accessor(const void* data, std::size_t size, int component, const char* type,
                       bool normalized = false) {
    const std::size_t at = view(std::string(static_cast<const char*>(data), size));
    root["accessors"].push_back(
        {{"bufferView", at}, {"componentType", component}, {"count", 3}, {"type", type}});
    if (normalized) root["accessors"].back()["normalized"] = true;
    return root["accessors"].size() - 1;
  }

  /// A texture of a small picture; returns its index.
  std::size_t texture(int seed = 0, Json sampler = nullptr) {
    root["images"].push_back(data_uri(png_of(small_picture(2, 2, seed))));
    Json added = {{"source", root["images"].size() - 1}};
    if (!sampler.is_null()) {
      root["samplers"].push_back(sampler);
      added["sampler"] = root["samplers"].size() - 1;
    }
    root["textures"].push_back(added);
    return root["textures"].size() - 1;
  }

  Json& base_texture(std::size_t texture) {
    Json& info = material()["pbrMetallicRoughness"]["baseColorTexture"];
    info["index"] = texture;
    return info;
  }

  Expected<Scene> import() {
    Json whole = root;
    std::set<std::string> extensions;
    collect_extensions(root, extensions);
    if (!extensions.empty()) whole["extensionsUsed"] = extensions;
    whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "b.bin"}}};
    testing::write_text(folder / "b.bin", bytes);
    testing::write_text(folder / "a.gltf", whole.dump());
    return formats::import_gltf(folder / "a.gltf");
  }

  Scene scene() {
    auto scene = import();
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }

  /// The one material of a file that imports without a warning.
  Material read() {
    const Scene imported = scene();
    EXPECT_TRUE(imported.warnings.empty()) << imported.warnings[0];
    EXPECT_FALSE(imported.materials.empty());
    return imported.materials.empty() ? Material{} : imported.materials[0];
  }
};

/// One of the warnings says `words`.
inline void expect_warning(const Scene& scene, const std::string& words) {
  const auto says = [&](const std::string& warning) { return warning.find(words) != std::string::npos; };
  EXPECT_TRUE(std::any_of(scene.warnings.begin(), scene.warnings.end(), says))
      << words << " in: " << fmt::format("{}", fmt::join(scene.warnings, " | "));
  for (const std::string& warning : scene.warnings) EXPECT_EQ(warning.back(), '.') << warning;
}

}  // namespace tenebra::testing
