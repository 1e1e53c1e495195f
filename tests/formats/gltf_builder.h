// A glTF file made by a test: JSON and one buffer, written into a folder of its own and imported.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/import_scene.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {

using Json = nlohmann::json;

struct GltfBuilder {
  Json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  std::string bytes;

  std::size_t view(const std::string& data) {
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
    bytes += data;
    return root["bufferViews"].size() - 1;
  }

  template <class T>
  std::size_t accessor(const std::vector<T>& values, int component_type, const char* type, std::size_t width,
                       bool bounds = false) {
    std::string data(values.size() * sizeof(T), '\0');
    std::memcpy(data.data(), values.data(), data.size());
    Json entry = {{"bufferView", view(data)},
                  {"componentType", component_type},
                  {"count", values.size() / width},
                  {"type", type}};
    for (std::size_t c = 0; bounds && c < width; ++c) {
      T low = values[c], high = values[c];
      for (std::size_t i = c; i < values.size(); i += width)
        low = std::min(low, values[i]), high = std::max(high, values[i]);
      entry["min"].push_back(low);
      entry["max"].push_back(high);
    }
    root["accessors"].push_back(entry);
    return root["accessors"].size() - 1;
  }

  std::size_t floats(const std::vector<float>& values, const char* type, std::size_t width,
                     bool bounds = false) {
    return accessor(values, 5126, type, width, bounds);
  }

  /// A triangle of corners (0,0,0), (1,0,0), (0,1,0), shown by node 0.
  void add_triangle() {
    const std::size_t positions = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3, true);
    root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
    root["nodes"] = {{{"mesh", 0}}};
  }

  void write(const TemporaryFolder& folder) const {
    Json whole = root;
    if (!bytes.empty() && !whole.contains("buffers"))
      whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "b.bin"}}};
    write_text(folder / "b.bin", bytes);
    write_text(folder / "a.gltf", whole.dump());
  }

  Expected<Scene> import(const formats::ImportOptions& options = {}) const {
    const TemporaryFolder folder;
    write(folder);
    return formats::import_gltf(folder / "a.gltf", options);
  }
};

inline bool contains(const std::vector<std::string>& sentences, const std::string& part) {
  for (const std::string& sentence : sentences)
    if (sentence.find(part) != std::string::npos) return true;
  return false;
}

inline std::string joined(const std::vector<std::string>& sentences) {
  std::string all;
  for (const std::string& sentence : sentences) all += sentence + "\n";
  return all;
}

}  // namespace tenebra::testing
