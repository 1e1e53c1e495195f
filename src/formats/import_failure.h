// How the readers of this folder give up: one sentence thrown inside, caught where the folder's API begins.
#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace tenebra::formats {

/// What stops an import; what() is the sentence without the file's name.
struct ImportFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file that is there and cannot be read: never a warning, as the next attempt may give another picture.
struct UnreadableFile : ImportFailure {
  using ImportFailure::ImportFailure;
};

/// Throws an ImportFailure: `refuse("{}: found {}, expected {}", place, found, expected);`
template <class... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> format, Args&&... args) {
  throw ImportFailure(fmt::format(format, std::forward<Args>(args)...));
}

/// `text` of a file for a sentence: names may be long (data URIs) or hold control characters.
inline std::string shown(std::string_view text) {
  constexpr std::size_t longest = 80;
  std::string word(text.substr(0, longest));
  for (char& c : word)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  return text.size() > longest ? word + "..." : word;
}

}  // namespace tenebra::formats
