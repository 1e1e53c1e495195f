#include "formats/gltf_check/schema.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <set>

#include "formats/gltf_check/schema_check.h"
#include "formats/gltf_check/unused.h"
#include "formats/import_failure.h"

namespace tenebra::formats {
namespace {

using Json = nlohmann::json;

/// An accessor of a type that this version of glTF does not know is allowed, but nothing may use it.
void blank_unknown_accessors(Json& root, std::vector<std::string>& warnings) {
  static const std::set<std::string> types = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  if (!root.contains("accessors")) return;
  for (std::size_t i = 0; i < root["accessors"].size(); ++i) {
    Json& accessor = root["accessors"][i];
    const auto component = accessor["componentType"].get<std::uint64_t>();
    const bool known_component =
        (component >= 5120 && component <= 5123) || component == 5125 || component == 5126;
    const bool known_type = types.contains(accessor["type"].get<std::string>());
    if (known_type && known_component) continue;
    warnings.push_back(fmt::format("accessors[{}].{}: found an unknown type, left unread.", i,
                                   known_type ? "componentType" : "type"));
    accessor = {{"type", "SCALAR"}, {"componentType", 5126}, {"count", 0}};
  }
}

/// A camera of a type that this version of glTF does not know leaves its place in the table to another.
void replace_unknown_cameras(Json& root, std::vector<std::string>& warnings) {
  if (!root.contains("cameras")) return;
  for (std::size_t i = 0; i < root["cameras"].size(); ++i) {
    Json& camera = root["cameras"][i];
    const std::string type = camera["type"].get<std::string>();
    if (type == "perspective" || type == "orthographic") continue;
    warnings.push_back(
        fmt::format("cameras[{}].type: found '{}', expected perspective or orthographic; a "
                    "perspective camera takes its place.",
                    i, type.substr(0, 40)));
    camera = {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}};
  }
}

std::set<std::size_t> animated_nodes(const Json& root) {
  std::set<std::size_t> nodes;
  if (!root.contains("animations")) return nodes;
  for (const Json& animation : root["animations"])
    for (const Json& channel : animation["channels"])
      if (channel["target"].contains("node")) nodes.insert(channel["target"]["node"].get<std::size_t>());
  return nodes;
}

/// A node states its place once; what is stated beside it and moves nothing is dropped.
void part_matrix_from_parts(Json& root, std::vector<std::string>& warnings) {
  if (!root.contains("nodes")) return;
  // Not static: JSON takes memory where it is destroyed, which at the program's end may be lacking.
  const std::pair<const char*, Json> parts[] = {
      {"translation", {0, 0, 0}}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, 1, 1}}};
  const Json unit = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const std::set<std::size_t> animated = animated_nodes(root);
  for (std::size_t i = 0; i < root["nodes"].size(); ++i) {
    Json& node = root["nodes"][i];
    if (!node.contains("matrix")) continue;
    bool beside = false, moves = false;
    for (const auto& [name, at_rest] : parts) {
      beside |= node.contains(name);
      moves |= node.contains(name) && node[name] != at_rest;
    }
    const bool is_unit = node["matrix"] == unit;
    if (!beside) continue;
    if (moves && !is_unit)
      refuse("nodes[{}].matrix: found beside translation, rotation or scale, expected one or the other", i);
    if (!is_unit || animated.contains(i))
      warnings.push_back(fmt::format(
          "nodes[{}].matrix: found beside translation, rotation or scale, expected one or the other; what "
          "moves nothing is left out.",
          i));
    if (moves || (is_unit && animated.contains(i))) {
      node.erase("matrix");
      continue;
    }
    for (const auto& [name, at_rest] : parts) node.erase(name);
  }
}

/// tinygltf refuses indices without a bufferView (zeros, or compressed ones): they pass it under `extras`.
void hide_indices_without_view(Json& root) {
  if (!root.contains("meshes") || !root.contains("accessors")) return;
  for (Json& mesh : root["meshes"])
    for (Json& primitive : mesh["primitives"]) {
      if (!primitive.contains("indices")) continue;
      if (root["accessors"][primitive["indices"].get<std::size_t>()].contains("bufferView")) continue;
      primitive["extras"]["indices"] = primitive["indices"];
      primitive.erase("indices");
    }
}

/// tinygltf refuses strides that glTF does not allow; where the elements lie they say all the same.
void hide_odd_strides(Json& root) {
  if (!root.contains("bufferViews")) return;
  for (Json& view : root["bufferViews"]) {
    constexpr std::uint64_t most = 252, most_read = 1 << 30;
    const std::uint64_t stride = view.contains("byteStride") ? view["byteStride"].get<std::uint64_t>() : 0;
    if ((stride <= most && stride % 4 == 0) || stride > most_read) continue;
    view["extras"]["byteStride"] = stride;
    view.erase("byteStride");
  }
}

/// A spot's cone where the file states none: of glTF's default angles.
void add_missing_cones(Json& root, std::vector<std::string>& warnings) {
  const Json::json_pointer place("/extensions/KHR_lights_punctual/lights");
  if (!root.contains(place)) return;
  for (std::size_t i = 0; i < root[place].size(); ++i) {
    Json& light = root[place][i];
    if (light["type"] != "spot" || light.contains("spot")) continue;
    light["spot"] = {{"innerConeAngle", 0}};
    warnings.push_back(fmt::format(
        "extensions.KHR_lights_punctual.lights[{}].spot: found nothing, expected a cone; one of 45 degrees "
        "around its middle is used.",
        i));
  }
}

/// tinygltf drops channels without a node in silence, and those of KHR_animation_pointer have none.
void mark_channels_without_nodes(Json& root) {
  if (!root.contains("animations")) return;
  for (Json& animation : root["animations"])
    for (Json& channel : animation["channels"])
      if (!channel["target"].contains("node")) channel["target"]["node"] = -1;
}

/// "version": 2.0 means what "2.0" does, and "scene": 0 nothing in a file without scenes.
void mend_root(Json& root, std::vector<std::string>& warnings) {
  if (!root.is_object()) return;
  if (root.contains("meshes") && root["meshes"].is_object())
    refuse("meshes: found tables of glTF 1.0, expected 2.0: gltf-pipeline makes glTF 2.0 of it");
  if (root.contains("asset") && root["asset"].is_object()) {
    Json& asset = root["asset"];
    if (asset.contains("version") && asset["version"].is_number()) asset["version"] = asset["version"].dump();
  }
  if (!root.contains("scene") || root.contains("scenes")) return;
  root.erase("scene");
  warnings.push_back("scene: found a reference, expected none in a file without scenes.");
}

}  // namespace

std::string check_gltf_schema(std::string_view json, std::vector<std::string>& warnings,
                              std::vector<UnusedContent>& unused) {
  Json root;
  try {
    root = Json::parse(json.begin(), json.end());
  } catch (const Json::parse_error& error) {
    refuse("JSON offset {}: found a syntax error, expected JSON", error.byte);
  } catch (const Json::out_of_range&) {
    refuse("JSON: found a number beyond the range of double, expected a smaller one");
  }
  mend_root(root, warnings);
  name_unused_looks(root, unused);
  schema::check_fields(root, warnings);
  part_matrix_from_parts(root, warnings);
  blank_unknown_accessors(root, warnings);
  replace_unknown_cameras(root, warnings);
  mark_channels_without_nodes(root);
  hide_indices_without_view(root);
  hide_odd_strides(root);
  add_missing_cones(root, warnings);
  // tinygltf fetches what stands under "buffers" and "images" by itself; what stands under "extras" it leaves
  // to its caller.
  if (root.contains("buffers")) root["extras"]["buffers"] = std::move(root["buffers"]);
  root.erase("buffers");
  if (root.contains("images")) {
    // It drops empty objects from lists, which would give the images after them other numbers.
    for (Json& image : root["images"])
      if (image.empty()) image["name"] = "";
    root["extras"]["images"] = std::move(root["images"]);
  }
  root.erase("images");
  return root.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tenebra::formats
