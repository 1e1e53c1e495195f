#include "formats/gltf_check/unused.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

namespace tenebra::formats {
namespace {

using Json = nlohmann::json;
using Counts = std::map<std::string, std::size_t>;

/// Member `name` of `value`, or an empty value: a file that is not checked yet may hold anything.
const Json& member(const Json& value, const char* name) {
  static const Json nothing;
  if (!value.is_object()) return nothing;
  const auto found = value.find(name);
  return found == value.end() ? nothing : *found;
}

bool is_read(const std::string& extension) {
  static const std::set<std::string_view> names = {
      "KHR_materials_emissive_strength", "KHR_materials_ior",          "KHR_materials_pbrSpecularGlossiness",
      "KHR_materials_specular",          "KHR_materials_transmission", "KHR_materials_unlit"};
  return names.contains(extension);
}

void count_material(const Json& material, Counts& counts) {
  const Json& extensions = member(material, "extensions");
  if (!extensions.is_object()) return;
  for (const auto& [name, unused] : extensions.items())
    if (!is_read(name)) ++counts[name];
}

void count_primitive(const Json& primitive, Counts& counts) {
  const Json& attributes = member(primitive, "attributes");
  if (attributes.is_object()) {
    for (const auto& [name, unused] : attributes.items()) {
      const bool coordinates = name.starts_with("TEXCOORD_") && name != "TEXCOORD_0" && name != "TEXCOORD_1";
      if (coordinates || (name.starts_with("COLOR_") && name != "COLOR_0")) ++counts[name];
    }
  }
  if (!member(member(primitive, "extensions"), "KHR_materials_variants").is_null())
    ++counts["KHR_materials_variants"];
}

void report(const Counts& counts, std::vector<UnusedContent>& unused) {
  for (const auto& [name, count] : counts) {
    const std::string shown = Json(name).dump(-1, ' ', true, Json::error_handler_t::replace);
    unused.push_back({shown.substr(1, std::min<std::size_t>(shown.size() - 2, 60)), count});
  }
}

}  // namespace

void name_unused_looks(const Json& root, std::vector<UnusedContent>& unused) {
  Counts of_materials, of_primitives;
  const Json& materials = member(root, "materials");
  if (materials.is_array())
    for (const Json& material : materials) count_material(material, of_materials);
  const Json& meshes = member(root, "meshes");
  if (meshes.is_array())
    for (const Json& mesh : meshes) {
      const Json& primitives = member(mesh, "primitives");
      if (primitives.is_array())
        for (const Json& primitive : primitives) count_primitive(primitive, of_primitives);
    }
  constexpr std::size_t most_names = 100;
  while (of_materials.size() > most_names) of_materials.erase(std::prev(of_materials.end()));
  while (of_primitives.size() > most_names) of_primitives.erase(std::prev(of_primitives.end()));
  report(of_materials, unused);
  report(of_primitives, unused);
}

}  // namespace tenebra::formats
