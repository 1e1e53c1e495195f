// Makes the error of a function that can fail.
#pragma once

#include <fmt/core.h>

#include <tenebra/expected.h>
#include <utility>

namespace tenebra::base {

/// `return fail("{}: found {}, expected {}", path, found, expected);`
template <class... Args>
tl::unexpected<Error> fail(fmt::format_string<Args...> format, Args&&... args) {
  return tl::unexpected<Error>(Error{fmt::format(format, std::forward<Args>(args)...)});
}

}  // namespace tenebra::base
