// The shape of glTF's JSON: which properties there are, their types, which must be there, what they refer to.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tenebra/scene.h>

namespace tenebra::formats {

/// JSON reduced to the properties that Tenebra reads, each of the right type, every reference in range.
/// Throws ImportFailure with the JSON path of the first fault; harmless faults (textures, empty lists) add to
/// `warnings`, and so does what only looks depend on and is not read, which `unused` counts.
std::string check_gltf_schema(std::string_view json, std::vector<std::string>& warnings,
                              std::vector<UnusedContent>& unused);

}  // namespace tenebra::formats
