// What a glTF file says about looks and Tenebra does not use.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include <tenebra/scene.h>

namespace tenebra::formats {

/// Counts normal and occlusion textures, extensions of materials, and further sets of texture coordinates and
/// colours, as a file that is not checked yet has them: `unused` gets an entry for each name, `warnings` a
/// sentence.
void name_unused_looks(const nlohmann::json& root, std::vector<std::string>& warnings,
                       std::vector<UnusedContent>& unused);

}  // namespace tenebra::formats
