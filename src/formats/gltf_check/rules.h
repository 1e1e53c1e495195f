// Rules of the glTF specification whose breach changes nothing here: it is reported, and the file is read all
// the same.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace tenebra::formats {

/// Adds a sentence for each rule of the specification that `root` breaks, with the places, to `warnings`.
/// `root` may be any JSON; what is of another type than it must be is passed over, as check_gltf_schema
/// refuses it.
void check_gltf_rules(const nlohmann::json& root, std::vector<std::string>& warnings);

}  // namespace tenebra::formats
