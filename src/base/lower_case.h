// Words in any case: ASCII letters alone, whatever the locale.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tenebra::base {

/// `text` with its ASCII letters in lower case.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

/// The extension of a file's name, with its point, in lower case: ".gltf".
inline std::string extension_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

}  // namespace tenebra::base
