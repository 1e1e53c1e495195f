// Rules of single values: ranges, names, what goes together.
#include <initializer_list>

#include "formats/gltf_check/rule_report.h"

namespace tenebra::formats::rules {
namespace {

void expect_range(const Json& object, const char* name, double least, double most, const std::string& place,
                  Report& report) {
  const Json& value = get(object, name);
  const auto check = [&](const Json& number) {
    if (!number.is_number()) return;
    const double found = number.get<double>();
    if (found < least || found > most)
      report.add(most < 1e30 ? fmt::format("expected {} to {}", least, most)
                             : fmt::format("expected {} or more", least),
                 fmt::format("{}.{}", place, name));
  };
  if (value.is_array())
    for (const Json& number : value) check(number);
  check(value);
}

constexpr double unbounded = 1e39;

void check_textures_of(const Json& value, const std::string& place, Report& report) {
  if (!value.is_object()) return;
  for (const auto& [name, child] : value.items()) {
    if (!child.is_object() || name == "extras") continue;
    const std::string at = place + "." + name;
    if (name.ends_with("Texture")) {
      const Json& set = get(child, "texCoord");
      if (!set.is_null() && !index_in(child, "texCoord"))
        report.add("expected an integer of 0 or more", at + ".texCoord");
      for (const char* number : {"scale", "strength"})
        if (!get(child, number).is_null() && !get(child, number).is_number())
          report.add("expected a number", fmt::format("{}.{}", at, number));
      expect_range(child, "strength", 0, 1, at, report);
    }
    check_textures_of(child, at, report);
  }
}

void check_materials(const Json& root, Report& report) {
  for_each(root, "materials", "", [&](const Json& material, const std::string& place) {
    const Json& pbr = get(material, "pbrMetallicRoughness");
    expect_range(pbr, "baseColorFactor", 0, 1, place + ".pbrMetallicRoughness", report);
    expect_range(pbr, "metallicFactor", 0, 1, place + ".pbrMetallicRoughness", report);
    expect_range(pbr, "roughnessFactor", 0, 1, place + ".pbrMetallicRoughness", report);
    expect_range(material, "emissiveFactor", 0, 1, place, report);
    expect_range(material, "alphaCutoff", 0, unbounded, place, report);
    for (const char* factor : {"metallicFactor", "roughnessFactor"})
      if (!get(pbr, factor).is_null() && !get(pbr, factor).is_number())
        report.add("expected a number", fmt::format("{}.pbrMetallicRoughness.{}", place, factor));
    if (!get(material, "alphaCutoff").is_null() && !get(material, "alphaCutoff").is_number())
      report.add("expected a number", place + ".alphaCutoff");
    if (!get(material, "alphaMode").is_null() && !get(material, "alphaMode").is_string())
      report.add("expected a string", place + ".alphaMode");
    if (!get(material, "doubleSided").is_null() && !get(material, "doubleSided").is_boolean())
      report.add("expected true or false", place + ".doubleSided");
    check_textures_of(material, place, report);
  });
}

void check_images(const Json& root, Report& report) {
  for_each(root, "images", "", [&](const Json& image, const std::string& place) {
    const bool by_uri = !get(image, "uri").is_null(), by_view = !get(image, "bufferView").is_null();
    if (by_uri == by_view && get(image, "extensions").is_null())
      report.add("expected either a uri or a bufferView", place);
    if (by_view && get(image, "mimeType").is_null())
      report.add("found a bufferView without a mimeType", place);
    if (!get(image, "mimeType").is_null() && !get(image, "mimeType").is_string())
      report.add("expected a string", place + ".mimeType");
  });
  for_each(root, "samplers", "", [&](const Json& sampler, const std::string& place) {
    for (const char* name : {"magFilter", "minFilter", "wrapS", "wrapT"})
      if (!get(sampler, name).is_null() && !index_in(sampler, name))
        report.add("expected an integer", fmt::format("{}.{}", place, name));
  });
}

void check_cameras(const Json& root, Report& report) {
  for_each(root, "cameras", "", [&](const Json& camera, const std::string& place) {
    const bool perspective = !get(camera, "perspective").is_null();
    const bool orthographic = !get(camera, "orthographic").is_null();
    if (perspective == orthographic) report.add("expected either perspective or orthographic", place);
    const Json& lens = get(camera, "perspective");
    for (const char* name : {"aspectRatio", "zfar"})
      if (get(lens, name).is_number() && !(get(lens, name).get<double>() > 0))
        report.add("expected more than 0", fmt::format("{}.perspective.{}", place, name));
  });
}

void check_lights(const Json& root, Report& report) {
  const std::string path = "extensions.KHR_lights_punctual.";
  for_each(get(get(root, "extensions"), "KHR_lights_punctual"), "lights", path,
           [&](const Json& light, const std::string& place) {
             expect_range(light, "color", 0, 1, place, report);
             if (get(light, "range").is_number() && !(get(light, "range").get<double>() > 0))
               report.add("expected more than 0", place + ".range");
             if (text_in(light, "type") == "spot" && !get(light, "spot").is_object())
               report.add("found type spot without a spot object", place);
           });
}

void check_buffers(const Json& root, Report& report) {
  for_each(root, "buffers", "", [&](const Json& buffer, const std::string& place) {
    const std::string uri = text_in(buffer, "uri").substr(0, 60);
    if (uri.starts_with("data:") && !uri.starts_with("data:application/octet-stream") &&
        !uri.starts_with("data:application/gltf-buffer"))
      report.add("expected the type application/octet-stream or application/gltf-buffer", place + ".uri");
  });
}

void check_names(const Json& root, Report& report) {
  for (const char* table : {"accessors", "animations", "bufferViews", "buffers", "cameras", "images",
                            "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"})
    for_each(root, table, "", [&](const Json& entry, const std::string& place) {
      if (!get(entry, "name").is_null() && !get(entry, "name").is_string())
        report.add("expected a string", place + ".name");
      if (!get(entry, "extensions").is_null() && !get(entry, "extensions").is_object())
        report.add("expected an object", place + ".extensions");
    });
}

void check_rotations(const Json& root, Report& report) {
  for_each(root, "nodes", "", [&](const Json& node, const std::string& place) {
    expect_range(node, "rotation", -1, 1, place, report);
  });
}

}  // namespace

void check_value_rules(const Json& root, Report& report) {
  check_names(root, report);
  check_materials(root, report);
  check_images(root, report);
  check_cameras(root, report);
  check_lights(root, report);
  check_buffers(root, report);
  check_rotations(root, report);
}

}  // namespace tenebra::formats::rules
