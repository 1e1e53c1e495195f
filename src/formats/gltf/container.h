// The outer form of a glTF file: JSON text, or a GLB holding JSON and a binary chunk; nothing parsed yet.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tenebra::formats {

struct GltfContainer {
  std::string_view json;
  std::optional<std::string_view> binary;  ///< the BIN chunk of a GLB
  bool is_glb = false;
  std::vector<std::string> warnings;  ///< breaches that leave in no doubt where the chunks lie
};

/// Splits `bytes` (views into it). Throws ImportFailure where a GLB's chunks are not whole or in doubt.
GltfContainer split_gltf(std::string_view bytes, bool expect_glb);

/// Refuses JSON too deep, or with too many values, for the parsers behind it: more than 64 levels, two
/// million values or 200,000 objects. One pass, no recursion.
void check_json_size(std::string_view json);

}  // namespace tenebra::formats
