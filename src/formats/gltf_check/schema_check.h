// The check of a glTF file's JSON against the tables of its properties.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace tenebra::formats::schema {

/// Reduces `root` to the properties of root_fields(), each of the right type, every reference in range.
/// Throws ImportFailure with the JSON path of the first fault; harmless ones add to `warnings`.
void check_fields(nlohmann::json& root, std::vector<std::string>& warnings);

}  // namespace tenebra::formats::schema
