// What a glTF file says about looks and Tenebra does not use.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include <tenebra/scene.h>

namespace tenebra::formats {

/// Counts extensions of materials that are not read, and further sets of texture coordinates and colours, as
/// a file that is not checked yet has them: an entry for each name.
void name_unused_looks(const nlohmann::json& root, std::vector<UnusedContent>& unused);

}  // namespace tenebra::formats
