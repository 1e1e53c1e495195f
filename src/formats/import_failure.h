// How the readers of this folder give up: one sentence thrown inside, caught where the folder's API begins.
#pragma once

#include <fmt/core.h>

#include <stdexcept>
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

}  // namespace tenebra::formats
