// What the checks of rules share: reading JSON that may be anything, and collecting breaches by rule.
#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tenebra::formats::rules {

using Json = nlohmann::json;

/// Breaches by rule: one sentence for each rule, with the first places.
class Report {
public:
  void add(const std::string& rule, const std::string& place) {
    Breach& breach = breaches_[rule];
    constexpr std::size_t most_places = 4;
    if (breach.count++ < most_places) breach.places += (breach.places.empty() ? "" : ", ") + place;
  }

  void write(std::vector<std::string>& warnings) const {
    constexpr std::size_t most_places = 4;
    for (const auto& [rule, breach] : breaches_) {
      const std::string more =
          breach.count > most_places ? fmt::format(" and {} more", breach.count - most_places) : "";
      warnings.push_back(fmt::format("{}{}: {}.", breach.places, more, rule));
    }
  }

private:
  struct Breach {
    std::size_t count = 0;
    std::string places;
  };
  std::map<std::string, Breach> breaches_;
};

/// Member `name` of `value` if that is an object that has it, else null.
inline const Json& get(const Json& value, const char* name) {
  static const Json nothing;
  if (!value.is_object()) return nothing;
  const auto found = value.find(name);
  return found == value.end() ? nothing : *found;
}

inline const Json& at(const Json& array, std::size_t index) {
  static const Json nothing;
  return array.is_array() && index < array.size() ? array[index] : nothing;
}

inline std::optional<std::size_t> index_in(const Json& value, const char* name) {
  const Json& found = get(value, name);
  if (!found.is_number_unsigned() && !(found.is_number_integer() && found.get<std::int64_t>() >= 0))
    return std::nullopt;
  return found.get<std::size_t>();
}

inline std::string text_in(const Json& value, const char* name) {
  const Json& found = get(value, name);
  return found.is_string() ? found.get<std::string>() : std::string();
}

/// Calls visit(entry, place) for all entries of the table `name` of `object`.
template <class Visit>
void for_each(const Json& object, const char* name, const std::string& path, Visit visit) {
  const Json& table = get(object, name);
  if (!table.is_array()) return;
  for (std::size_t i = 0; i < table.size(); ++i) visit(table[i], fmt::format("{}{}[{}]", path, name, i));
}

// One group of rules each (rules_*.cpp).
void check_geometry_rules(const Json& root, Report& report);
void check_tree_rules(const Json& root, Report& report);
void check_value_rules(const Json& root, Report& report);

}  // namespace tenebra::formats::rules
