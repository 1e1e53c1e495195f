#include "formats/gltf_check/schema_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "formats/gltf_check/schema_fields.h"
#include "formats/import_failure.h"

namespace tenebra::formats::schema {
namespace {

using Json = nlohmann::json;

/// What is not needed, or what only looks depend on: a fault there costs the name, the texture or the
/// extension, never the scene.
bool is_harmless(std::string_view name) {
  static const std::set<std::string_view> plain = {"textures",
                                                   "images",
                                                   "samplers",
                                                   "alphaMode",
                                                   "alphaCutoff",
                                                   "doubleSided",
                                                   "metallicFactor",
                                                   "roughnessFactor",
                                                   "name",
                                                   "min",
                                                   "max",
                                                   "target",
                                                   "skeleton",
                                                   "minVersion",
                                                   "extensionsUsed",
                                                   "interpolation",
                                                   "pbrMetallicRoughness",
                                                   "emissiveFactor"};
  return plain.contains(name) || name.ends_with("Texture") || name.starts_with("KHR_materials_") ||
         name.starts_with("KHR_texture_") || name == "EXT_texture_webp";
}

/// Samplers and targets of animations share their names with what matters to textures and views.
bool may_be_odd_in_clips(std::string_view name) {
  return name == "name" || name == "interpolation";
}

class SchemaCheck {
public:
  SchemaCheck(Json& root, std::vector<std::string>& warnings) : root_(root), warnings_(warnings) {}

  void run() {
    if (!root_.is_object()) refuse("JSON: found {}, expected an object", root_.type_name());
    check_object(root_, "", root_fields());
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
      if (is_harmless(field.name) && (!path.starts_with("animations") || may_be_odd_in_clips(field.name))) {
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
      warnings_.push_back(fmt::format("{}; it is not needed and is left out.", failure.what()));
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
    constexpr double largest_float = std::numeric_limits<float>::max();
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
    if (value.empty()) warnings_.push_back(fmt::format("{}: found an empty array, expected entries.", place));
    for (std::size_t i = 0; i < value.size(); ++i) check(value[i], fmt::format("{}[{}]", place, i));
  }

  void check_numbers(Json& value, const std::string& place, std::size_t length) {
    check_items(value, place, [&](Json& item, const std::string& at) { check_number(item, at); });
    if (length != 0 && value.size() != length)
      refuse("{}: found {} numbers, expected {}", place, value.size(), length);
  }

  /// What is named twice counts once, but for joints, whose place in the list matters.
  void check_refs(Json& value, const std::string& place, const char* section) {
    std::set<std::uint64_t> seen;
    Json once = Json::array();
    std::string first;  // what is repeated
    std::size_t repeats = 0;
    check_items(value, place, [&](Json& item, const std::string& at) {
      check_ref(item, at, section);
      if (seen.insert(item.get<std::uint64_t>()).second)
        once.push_back(item);
      else if (repeats++ == 0)
        first = fmt::format("{}: found {} twice", at, shorten(item));
    });
    if (repeats > 0)
      warnings_.push_back(fmt::format("{}{}, expected each once.", first,
                                      repeats > 1 ? fmt::format(", and {} more repeats", repeats - 1) : ""));
    if (!place.ends_with(".joints")) value = std::move(once);
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
        if (std::string_view(field.name) == "extras") value = meaningful_extras(value, field.fields);
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
      case Kind::object:
        return value.is_object();
      default:
        return value.is_array() && value.size() == field.length &&
               std::all_of(value.begin(), value.end(), is_number);
    }
  }

  /// `extras` may hold anything; what does not look like one of `fields` was written by other programs.
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

}  // namespace

void check_fields(Json& root, std::vector<std::string>& warnings) {
  SchemaCheck(root, warnings).run();
}

}  // namespace tenebra::formats::schema
