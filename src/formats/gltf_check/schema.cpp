#include "formats/gltf_check/schema.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "formats/gltf_check/rules.h"
#include "formats/gltf_check/unused.h"
#include "formats/import_failure.h"

namespace tenebra::formats {
namespace {

using Json = nlohmann::json;

enum class Kind {
  string,
  boolean,
  number,
  integer,
  ref,
  refs,
  numbers,
  strings,
  object,
  objects,
  attributes,
  ids,  ///< an object of integers
  targets
};

struct Field {
  const char* name;
  Kind kind;
  bool required = false;
  const char* section = "";         ///< ref, refs: the root table referred to
  std::size_t length = 0;           ///< numbers: how many; 0: any, at least one
  std::span<const Field> fields{};  ///< object, objects
};

constexpr bool required = true;
constexpr Field name_field{"name", Kind::string};
constexpr Field extras_fields[] = {{"casts_shadow", Kind::boolean}};
constexpr Field extras_field{"extras", Kind::object, false, "", 0, extras_fields};

constexpr Field material_extras_fields[] = {{"casts_shadow", Kind::boolean},
                                            {"ambient", Kind::numbers, false, "", 3},
                                            {"base_color", Kind::numbers, false, "", 3},
                                            {"emissive", Kind::numbers, false, "", 3},
                                            {"model", Kind::string},
                                            {"specular", Kind::numbers, false, "", 3},
                                            {"phong_exponent", Kind::number},
                                            {"transmission", Kind::number}};
constexpr Field light_extras_fields[] = {{"falloff", Kind::string}, {"intensity", Kind::number}};

constexpr Field asset_fields[] = {{"version", Kind::string, required}, {"minVersion", Kind::string}};
constexpr Field scene_extras_fields[] = {{"ambient_light", Kind::numbers, false, "", 3},
                                         {"background", Kind::numbers, false, "", 3},
                                         {"transfer", Kind::string}};
constexpr Field scene_fields[] = {name_field,
                                  {"extras", Kind::object, false, "", 0, scene_extras_fields},
                                  {"nodes", Kind::refs, false, "nodes"}};
constexpr Field light_link_fields[] = {{"light", Kind::integer, required}};
constexpr Field visibility_fields[] = {{"visible", Kind::boolean}};
constexpr Field instancing_fields[] = {{"attributes", Kind::attributes, required}};
constexpr Field node_extension_fields[] = {
    {"EXT_mesh_gpu_instancing", Kind::object, false, "", 0, instancing_fields},
    {"KHR_lights_punctual", Kind::object, false, "", 0, light_link_fields},
    {"EXT_lights_area", Kind::object, false, "", 0, light_link_fields},
    {"KHR_node_visibility", Kind::object, false, "", 0, visibility_fields}};
constexpr Field node_fields[] = {name_field,
                                 extras_field,
                                 {"camera", Kind::ref, false, "cameras"},
                                 {"children", Kind::refs, false, "nodes"},
                                 {"skin", Kind::ref, false, "skins"},
                                 {"matrix", Kind::numbers, false, "", 16},
                                 {"mesh", Kind::ref, false, "meshes"},
                                 {"rotation", Kind::numbers, false, "", 4},
                                 {"scale", Kind::numbers, false, "", 3},
                                 {"translation", Kind::numbers, false, "", 3},
                                 {"weights", Kind::numbers},
                                 {"extensions", Kind::object, false, "", 0, node_extension_fields}};
constexpr Field draco_fields[] = {{"bufferView", Kind::ref, required, "bufferViews"},
                                  {"attributes", Kind::ids, required}};
constexpr Field primitive_extension_fields[] = {
    {"KHR_draco_mesh_compression", Kind::object, false, "", 0, draco_fields}};
constexpr Field primitive_fields[] = {{"extensions", Kind::object, false, "", 0, primitive_extension_fields},
                                      {"attributes", Kind::attributes, required},
                                      {"indices", Kind::ref, false, "accessors"},
                                      {"material", Kind::ref, false, "materials"},
                                      {"mode", Kind::integer},
                                      {"targets", Kind::targets}};
constexpr Field mesh_fields[] = {name_field,
                                 extras_field,
                                 {"primitives", Kind::objects, required, "", 0, primitive_fields},
                                 {"weights", Kind::numbers}};
constexpr Field sparse_index_fields[] = {{"bufferView", Kind::ref, required, "bufferViews"},
                                         {"byteOffset", Kind::integer},
                                         {"componentType", Kind::integer, required}};
constexpr Field sparse_value_fields[] = {{"bufferView", Kind::ref, required, "bufferViews"},
                                         {"byteOffset", Kind::integer}};
constexpr Field sparse_fields[] = {{"count", Kind::integer, required},
                                   {"indices", Kind::object, required, "", 0, sparse_index_fields},
                                   {"values", Kind::object, required, "", 0, sparse_value_fields}};
constexpr Field accessor_fields[] = {name_field,
                                     {"bufferView", Kind::ref, false, "bufferViews"},
                                     {"byteOffset", Kind::integer},
                                     {"componentType", Kind::integer, required},
                                     {"normalized", Kind::boolean},
                                     {"count", Kind::integer, required},
                                     {"type", Kind::string, required},
                                     {"max", Kind::numbers},
                                     {"min", Kind::numbers},
                                     {"sparse", Kind::object, false, "", 0, sparse_fields}};
constexpr Field compressed_view_fields[] = {{"buffer", Kind::ref, required, "buffers"},
                                            {"byteOffset", Kind::integer},
                                            {"byteLength", Kind::integer, required},
                                            {"byteStride", Kind::integer, required},
                                            {"count", Kind::integer, required},
                                            {"mode", Kind::string, required},
                                            {"filter", Kind::string}};
constexpr Field view_extension_fields[] = {
    {"EXT_meshopt_compression", Kind::object, false, "", 0, compressed_view_fields}};
constexpr Field view_fields[] = {{"extensions", Kind::object, false, "", 0, view_extension_fields},
                                 {"buffer", Kind::ref, required, "buffers"},
                                 {"byteOffset", Kind::integer},
                                 {"byteLength", Kind::integer, required},
                                 {"byteStride", Kind::integer},
                                 {"target", Kind::integer}};
constexpr Field fallback_fields[] = {{"fallback", Kind::boolean}};
constexpr Field buffer_extension_fields[] = {
    {"EXT_meshopt_compression", Kind::object, false, "", 0, fallback_fields}};
constexpr Field buffer_fields[] = {{"uri", Kind::string},
                                   {"byteLength", Kind::integer, required},
                                   {"extensions", Kind::object, false, "", 0, buffer_extension_fields}};
constexpr Field transform_fields[] = {{"offset", Kind::numbers, false, "", 2},
                                      {"rotation", Kind::number},
                                      {"scale", Kind::numbers, false, "", 2},
                                      {"texCoord", Kind::integer}};
constexpr Field texture_info_extension_fields[] = {
    {"KHR_texture_transform", Kind::object, false, "", 0, transform_fields}};
constexpr Field texture_info_fields[] = {
    {"index", Kind::ref, required, "textures"},
    {"texCoord", Kind::integer},
    {"extensions", Kind::object, false, "", 0, texture_info_extension_fields}};
constexpr Field pbr_fields[] = {
    {"baseColorFactor", Kind::numbers, false, "", 4},
    {"metallicFactor", Kind::number},
    {"roughnessFactor", Kind::number},
    {"baseColorTexture", Kind::object, false, "", 0, texture_info_fields},
    {"metallicRoughnessTexture", Kind::object, false, "", 0, texture_info_fields}};
constexpr Field strength_fields[] = {{"emissiveStrength", Kind::number}};
constexpr Field glossiness_fields[] = {
    {"diffuseFactor", Kind::numbers, false, "", 4},
    {"specularFactor", Kind::numbers, false, "", 3},
    {"glossinessFactor", Kind::number},
    {"diffuseTexture", Kind::object, false, "", 0, texture_info_fields},
    {"specularGlossinessTexture", Kind::object, false, "", 0, texture_info_fields}};
constexpr Field transmission_fields[] = {
    {"transmissionFactor", Kind::number},
    {"transmissionTexture", Kind::object, false, "", 0, texture_info_fields}};
constexpr Field material_extension_fields[] = {
    {"KHR_materials_emissive_strength", Kind::object, false, "", 0, strength_fields},
    {"KHR_materials_unlit", Kind::object},
    {"KHR_materials_pbrSpecularGlossiness", Kind::object, false, "", 0, glossiness_fields},
    {"KHR_materials_transmission", Kind::object, false, "", 0, transmission_fields}};
constexpr Field material_fields[] = {name_field,
                                     {"extras", Kind::object, false, "", 0, material_extras_fields},
                                     {"pbrMetallicRoughness", Kind::object, false, "", 0, pbr_fields},
                                     {"normalTexture", Kind::object, false, "", 0, texture_info_fields},
                                     {"occlusionTexture", Kind::object, false, "", 0, texture_info_fields},
                                     {"emissiveTexture", Kind::object, false, "", 0, texture_info_fields},
                                     {"emissiveFactor", Kind::numbers, false, "", 3},
                                     {"alphaMode", Kind::string},
                                     {"alphaCutoff", Kind::number},
                                     {"doubleSided", Kind::boolean},
                                     {"extensions", Kind::object, false, "", 0, material_extension_fields}};
constexpr Field perspective_fields[] = {{"aspectRatio", Kind::number},
                                        {"yfov", Kind::number, required},
                                        {"znear", Kind::number, required},
                                        {"zfar", Kind::number}};
constexpr Field orthographic_fields[] = {{"xmag", Kind::number, required},
                                         {"ymag", Kind::number, required},
                                         {"znear", Kind::number, required},
                                         {"zfar", Kind::number, required}};
constexpr Field camera_fields[] = {name_field,
                                   {"type", Kind::string, required},
                                   {"perspective", Kind::object, false, "", 0, perspective_fields},
                                   {"orthographic", Kind::object, false, "", 0, orthographic_fields}};
constexpr Field skin_fields[] = {name_field,
                                 {"inverseBindMatrices", Kind::ref, false, "accessors"},
                                 {"joints", Kind::refs, required, "nodes"},
                                 {"skeleton", Kind::ref, false, "nodes"}};
constexpr Field pointer_fields[] = {{"pointer", Kind::string, required}};
constexpr Field target_extension_fields[] = {
    {"KHR_animation_pointer", Kind::object, false, "", 0, pointer_fields}};
constexpr Field target_fields[] = {{"node", Kind::ref, false, "nodes"},
                                   {"path", Kind::string, required},
                                   {"extensions", Kind::object, false, "", 0, target_extension_fields}};
constexpr Field channel_fields[] = {{"sampler", Kind::integer, required},
                                    {"target", Kind::object, required, "", 0, target_fields}};
constexpr Field sampler_fields[] = {{"input", Kind::ref, required, "accessors"},
                                    {"interpolation", Kind::string},
                                    {"output", Kind::ref, required, "accessors"}};
constexpr Field animation_fields[] = {name_field,
                                      {"channels", Kind::objects, required, "", 0, channel_fields},
                                      {"samplers", Kind::objects, required, "", 0, sampler_fields}};
constexpr Field spot_fields[] = {{"innerConeAngle", Kind::number}, {"outerConeAngle", Kind::number}};
constexpr Field rect_fields[] = {{"aspect", Kind::number}};
constexpr Field light_fields[] = {name_field,
                                  {"extras", Kind::object, false, "", 0, light_extras_fields},
                                  {"type", Kind::string, required},
                                  {"color", Kind::numbers, false, "", 3},
                                  {"intensity", Kind::number},
                                  {"range", Kind::number},
                                  {"size", Kind::number},
                                  {"spot", Kind::object, false, "", 0, spot_fields},
                                  {"rect", Kind::object, false, "", 0, rect_fields}};
constexpr Field lights_fields[] = {{"lights", Kind::objects, required, "", 0, light_fields}};
constexpr Field root_extension_fields[] = {{"KHR_lights_punctual", Kind::object, false, "", 0, lights_fields},
                                           {"EXT_lights_area", Kind::object, false, "", 0, lights_fields}};
constexpr Field source_fields[] = {{"source", Kind::ref, required, "images"}};
constexpr Field texture_extension_fields[] = {
    {"EXT_texture_webp", Kind::object, false, "", 0, source_fields},
    {"KHR_texture_basisu", Kind::object, false, "", 0, source_fields}};
constexpr Field texture_fields[] = {{"source", Kind::ref, false, "images"},
                                    {"sampler", Kind::ref, false, "samplers"},
                                    {"extensions", Kind::object, false, "", 0, texture_extension_fields}};
constexpr Field image_fields[] = {name_field,
                                  {"uri", Kind::string},
                                  {"mimeType", Kind::string},
                                  {"bufferView", Kind::ref, false, "bufferViews"}};
constexpr Field texture_sampler_fields[] = {{"magFilter", Kind::integer},
                                            {"minFilter", Kind::integer},
                                            {"wrapS", Kind::integer},
                                            {"wrapT", Kind::integer}};
constexpr Field root_fields[] = {{"asset", Kind::object, required, "", 0, asset_fields},
                                 {"extensionsUsed", Kind::strings},
                                 {"extensionsRequired", Kind::strings},
                                 {"scene", Kind::ref, false, "scenes"},
                                 {"scenes", Kind::objects, false, "", 0, scene_fields},
                                 {"nodes", Kind::objects, false, "", 0, node_fields},
                                 {"meshes", Kind::objects, false, "", 0, mesh_fields},
                                 {"accessors", Kind::objects, false, "", 0, accessor_fields},
                                 {"bufferViews", Kind::objects, false, "", 0, view_fields},
                                 {"buffers", Kind::objects, false, "", 0, buffer_fields},
                                 {"materials", Kind::objects, false, "", 0, material_fields},
                                 {"cameras", Kind::objects, false, "", 0, camera_fields},
                                 {"skins", Kind::objects, false, "", 0, skin_fields},
                                 {"animations", Kind::objects, false, "", 0, animation_fields},
                                 {"textures", Kind::objects, false, "", 0, texture_fields},
                                 {"images", Kind::objects, false, "", 0, image_fields},
                                 {"samplers", Kind::objects, false, "", 0, texture_sampler_fields},
                                 {"extensions", Kind::object, false, "", 0, root_extension_fields}};

/// What only looks depend on: a fault there costs the texture or the extension, never the scene.
bool is_about_looks(std::string_view name) {
  static const std::set<std::string_view> plain = {"textures",       "images",         "samplers",
                                                   "alphaMode",      "alphaCutoff",    "doubleSided",
                                                   "metallicFactor", "roughnessFactor"};
  return plain.contains(name) || name.ends_with("Texture") || name.starts_with("KHR_materials_") ||
         name.starts_with("KHR_texture_") || name == "EXT_texture_webp";
}

class SchemaCheck {
public:
  SchemaCheck(Json& root, std::vector<std::string>& warnings) : root_(root), warnings_(warnings) {}

  void run() {
    if (!root_.is_object()) refuse("JSON: found {}, expected an object", root_.type_name());
    check_object(root_, "", root_fields);
  }

private:
  void check_object(Json& object, const std::string& path, std::span<const Field> fields) {
    if (!object.is_object()) refuse("{}: found {}, expected an object", path, object.type_name());
    std::set<std::string_view> kept;
    for (const Field& field : fields) {
      const auto found = object.find(field.name);
      const std::string place = path.empty() ? field.name : path + "." + field.name;
      if (found == object.end()) {
        if (field.required) refuse("{}: found nothing, expected this property", place);
        continue;
      }
      // Samplers of animations share their name with the samplers of textures.
      if (is_about_looks(field.name) && !path.starts_with("animations")) {
        if (check_harmless(*found, place, field)) kept.insert(field.name);
      } else if (!drop_if_empty(*found, place, field)) {
        check_value(*found, place, field);
        kept.insert(field.name);
      }
    }
    for (auto it = object.begin(); it != object.end();)
      it = kept.contains(it.key()) ? ++it : object.erase(it);
  }

  /// Whether `value` may be used. Faulty entries of a table become empty objects, so that indices stay right.
  bool check_harmless(Json& value, const std::string& place, const Field& field) {
    if (drop_if_empty(value, place, field)) return false;
    if (field.kind == Kind::objects && value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        const bool whole = is_whole(fmt::format("{}[{}]", place, i),
                                    [&](const std::string& at) { check_object(value[i], at, field.fields); });
        if (!whole) value[i] = Json::object();
      }
      return true;
    }
    return is_whole(place, [&](const std::string& at) { check_value(value, at, field); });
  }

  template <class Check>
  bool is_whole(const std::string& place, Check check) {
    try {
      check(place);
      return true;
    } catch (const ImportFailure& failure) {
      warnings_.push_back(fmt::format("{}; it only matters to looks and is left out.", failure.what()));
      return false;
    }
  }

  bool drop_if_empty(const Json& value, const std::string& place, const Field& field) {
    if (!value.is_array() || !value.empty() || field.required) return false;
    warnings_.push_back(fmt::format("{}: found an empty list, expected entries; taken as absent.", place));
    return true;
  }

  void check_integer(Json& value, const std::string& place) {
    if (value.is_number_float() && std::abs(value.get<double>()) < 9e15 &&
        value.get<double>() == std::floor(value.get<double>()))
      value = static_cast<std::int64_t>(value.get<double>());
    if (!value.is_number_integer()) refuse("{}: found {}, expected an integer", place, shorten(value));
    if (!value.is_number_unsigned() && value.get<std::int64_t>() < 0)
      refuse("{}: found {}, expected 0 or more", place, shorten(value));
    if (value.get<std::uint64_t>() > (std::uint64_t{1} << 53))
      refuse("{}: found {}, expected less than 2^53", place, shorten(value));
    value = value.get<std::uint64_t>();
  }

  void check_ref(Json& value, const std::string& place, const char* section) {
    check_integer(value, place);
    const auto table = root_.find(section);
    const std::size_t size = table != root_.end() && table->is_array() ? table->size() : 0;
    if (value.get<std::uint64_t>() >= size)
      refuse("{}: found reference {}, expected one of the {} {}", place, shorten(value), size, section);
  }

  void check_number(const Json& value, const std::string& place) {
    constexpr double largest_float = 3.4e38;
    if (!value.is_number()) refuse("{}: found {}, expected a number", place, shorten(value));
    if (!(std::abs(value.get<double>()) <= largest_float))
      refuse("{}: found {}, expected a number that a float can hold", place, shorten(value));
  }

  void check_attributes(Json& value, const std::string& place) {
    if (!value.is_object()) refuse("{}: found {}, expected an object", place, value.type_name());
    for (auto& [name, accessor] : value.items()) check_ref(accessor, place + "." + name, "accessors");
  }

  void check_ids(Json& value, const std::string& place) {
    if (!value.is_object()) refuse("{}: found {}, expected an object", place, value.type_name());
    for (auto& [name, id] : value.items()) check_integer(id, place + "." + name);
  }

  template <class Check>
  void check_items(Json& value, const std::string& place, Check check) {
    if (!value.is_array()) refuse("{}: found {}, expected an array", place, shorten(value));
    if (value.empty()) refuse("{}: found an empty array, expected at least one entry", place);
    for (std::size_t i = 0; i < value.size(); ++i) check(value[i], fmt::format("{}[{}]", place, i));
  }

  void check_numbers(Json& value, const std::string& place, std::size_t length) {
    check_items(value, place, [&](Json& item, const std::string& at) { check_number(item, at); });
    if (length != 0 && value.size() != length)
      refuse("{}: found {} numbers, expected {}", place, value.size(), length);
  }

  void check_refs(Json& value, const std::string& place, const char* section) {
    std::set<std::uint64_t> seen;
    check_items(value, place, [&](Json& item, const std::string& at) {
      check_ref(item, at, section);
      if (!seen.insert(item.get<std::uint64_t>()).second)
        refuse("{}: found {} twice, expected each once", at, shorten(item));
    });
  }

  void check_value(Json& value, const std::string& place, const Field& field) {
    switch (field.kind) {
      case Kind::string:
        if (!value.is_string()) refuse("{}: found {}, expected a string", place, shorten(value));
        return;
      case Kind::boolean:
        if (!value.is_boolean()) refuse("{}: found {}, expected true or false", place, shorten(value));
        return;
      case Kind::number:
        return check_number(value, place);
      case Kind::integer:
        return check_integer(value, place);
      case Kind::ref:
        return check_ref(value, place, field.section);
      case Kind::refs:
        return check_refs(value, place, field.section);
      case Kind::numbers:
        return check_numbers(value, place, field.length);
      case Kind::strings:
        return check_items(value, place, [&](Json& item, const std::string& at) {
          if (!item.is_string()) refuse("{}: found {}, expected a string", at, shorten(item));
        });
      case Kind::object:
        if (field.name == extras_field.name) value = meaningful_extras(value, field.fields);
        return check_object(value, place, field.fields);
      case Kind::objects:
        return check_items(value, place,
                           [&](Json& item, const std::string& at) { check_object(item, at, field.fields); });
      case Kind::attributes:
        return check_attributes(value, place);
      case Kind::ids:
        return check_ids(value, place);
      case Kind::targets:
        return check_items(value, place,
                           [&](Json& item, const std::string& at) { check_attributes(item, at); });
    }
  }

  static bool looks_like(const Json& value, const Field& field) {
    const auto is_number = [](const Json& n) { return n.is_number(); };
    switch (field.kind) {
      case Kind::boolean:
        return value.is_boolean();
      case Kind::string:
        return value.is_string();
      case Kind::number:
        return value.is_number();
      default:
        return value.is_array() && value.size() == field.length &&
               std::all_of(value.begin(), value.end(), is_number);
    }
  }

  /// `extras` may hold anything; what does not look like one of `fields` is none of ours.
  static Json meaningful_extras(const Json& extras, std::span<const Field> fields) {
    Json kept = Json::object();
    if (!extras.is_object()) return kept;
    for (const Field& field : fields) {
      const auto found = extras.find(field.name);
      if (found == extras.end()) continue;
      const bool fits = looks_like(*found, field);
      if (fits) kept[std::string(field.name)] = *found;
    }
    return kept;
  }

  static std::string shorten(const Json& value) {
    if (value.is_structured()) return value.type_name();
    const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() <= 40 ? text : text.substr(0, 40) + "...";
  }

  Json& root_;
  std::vector<std::string>& warnings_;
};

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

/// tinygltf drops channels without a node in silence, and those of KHR_animation_pointer have none.
void mark_channels_without_nodes(Json& root) {
  if (!root.contains("animations")) return;
  for (Json& animation : root["animations"])
    for (Json& channel : animation["channels"])
      if (!channel["target"].contains("node")) channel["target"]["node"] = -1;
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
  check_gltf_rules(root, warnings);
  name_unused_looks(root, warnings, unused);
  SchemaCheck(root, warnings).run();
  blank_unknown_accessors(root, warnings);
  replace_unknown_cameras(root, warnings);
  mark_channels_without_nodes(root);
  hide_indices_without_view(root);
  // tinygltf fetches what stands under "buffers" by itself; under "extras" it leaves it to its caller. Images
  // too.
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
