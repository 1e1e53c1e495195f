#include "formats/gltf_check/rules.h"

#include <set>

#include "formats/gltf_check/rule_report.h"

namespace tenebra::formats {
namespace rules {
namespace {

std::set<std::string> names_in(const Json& root, const char* list, Report& report) {
  std::set<std::string> names;
  for_each(root, list, "", [&](const Json& name, const std::string& place) {
    if (name.is_string() && !names.insert(name.get<std::string>()).second)
      report.add("a name stands in it twice", place);
  });
  return names;
}

/// Adds the names of all extensions below `value` to `found`; `extras` may hold anything.
void find_extensions(const Json& value, const std::string& path, std::map<std::string, std::string>& found) {
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i)
      find_extensions(value[i], fmt::format("{}[{}]", path, i), found);
  if (!value.is_object()) return;
  for (const auto& [key, child] : value.items()) {
    if (key == "extras") continue;
    const std::string place = path.empty() ? key : path + "." + key;
    if (key == "extensions" && child.is_object())
      for (const auto& [name, extension] : child.items()) found.try_emplace(name, place);
    if (child.is_structured()) find_extensions(child, place, found);
  }
}

void check_extensions(const Json& root, Report& report) {
  const std::set<std::string> used = names_in(root, "extensionsUsed", report);
  const std::set<std::string> required = names_in(root, "extensionsRequired", report);
  for (const std::string& name : required)
    if (!used.contains(name))
      report.add("found an extension that extensionsUsed does not name", "extensionsRequired: " + name);
  if (used.contains("KHR_mesh_quantization") && !required.contains("KHR_mesh_quantization"))
    report.add("expected it in extensionsRequired too", "extensionsUsed: KHR_mesh_quantization");
  std::map<std::string, std::string> found;
  find_extensions(root, "", found);
  for (const auto& [name, place] : found)
    if (!used.contains(name))
      report.add("found an extension that extensionsUsed does not name", place + "." + name);
}

/// "2.0" as 2000, or nothing.
std::optional<int> version_number(const std::string& text) {
  const std::size_t dot = text.find('.');
  const auto digits = [](const std::string& part) {
    return !part.empty() && part.size() < 4 && part.find_first_not_of("0123456789") == std::string::npos;
  };
  if (dot == std::string::npos || !digits(text.substr(0, dot)) || !digits(text.substr(dot + 1)))
    return std::nullopt;
  return 1000 * std::stoi(text.substr(0, dot)) + std::stoi(text.substr(dot + 1));
}

void check_asset(const Json& root, Report& report) {
  const Json& asset = get(root, "asset");
  for (const char* name : {"version", "minVersion", "generator", "copyright"}) {
    const Json& value = get(asset, name);
    if (!value.is_null() && !value.is_string())
      report.add("found something that is no string, expected one", fmt::format("asset.{}", name));
  }
  const std::string version = text_in(asset, "version"), least = text_in(asset, "minVersion");
  for (const auto& [name, text] : {std::pair{"version", version}, std::pair{"minVersion", least}})
    if (!text.empty() && !version_number(text))
      report.add("expected MAJOR.MINOR", fmt::format("asset.{} '{}'", name, text.substr(0, 40)));
  if (version_number(version) && version_number(least) && *version_number(least) > *version_number(version))
    report.add("found it above asset.version", "asset.minVersion");
}

}  // namespace
}  // namespace rules

void check_gltf_rules(const nlohmann::json& root, std::vector<std::string>& warnings) {
  rules::Report report;
  rules::check_extensions(root, report);
  rules::check_asset(root, report);
  rules::check_geometry_rules(root, report);
  rules::check_tree_rules(root, report);
  rules::check_value_rules(root, report);
  report.write(warnings);
}

}  // namespace tenebra::formats
