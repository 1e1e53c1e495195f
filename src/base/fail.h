// Makes the error of a function that can fail.
#pragma once

#include <fmt/core.h>

#include <tenebra/expected.h>
#include <utility>

namespace tenebra::base {

/// `return fail(ErrorKind::file, "cannot write {}: {}", path, reason);`
template <class... Args>
tl::unexpected<Error> fail(ErrorKind kind, fmt::format_string<Args...> format, Args&&... args) {
  return tl::unexpected<Error>(Error{fmt::format(format, std::forward<Args>(args)...), kind});
}

/// `return fail("{}: found {}, expected {}", path, found, expected);`
template <class... Args>
tl::unexpected<Error> fail(fmt::format_string<Args...> format, Args&&... args) {
  return fail(ErrorKind::input, format, std::forward<Args>(args)...);
}

/// What a computation that was asked to end returns.
inline tl::unexpected<Error> stopped() {
  return tl::unexpected<Error>(Error{"stopped", ErrorKind::stopped});
}

}  // namespace tenebra::base
