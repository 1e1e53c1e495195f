// Results of what the world can make fail: files, imports, contexts, shaders, output.
#pragma once

#include <fmt/format.h>

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace tenebra {

/// One sentence for a person: place (file, line or stage), what was found, what was expected.
struct Error {
  std::string message;
};

template <class T>
using Expected = tl::expected<T, Error>;

/// `return fail("{}: found {}, expected {}", path, found, expected);`
template <class... Args>
tl::unexpected<Error> fail(fmt::format_string<Args...> format, Args&&... args) {
  return tl::unexpected<Error>(Error{fmt::format(format, std::forward<Args>(args)...)});
}

}  // namespace tenebra
