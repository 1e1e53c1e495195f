// The result of calls that can fail for outside reasons: files, imports, contexts, shaders, output.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace tenebra {

/// One sentence for a person to read: the place (file, line or stage), what was found, what was expected.
struct Error {
  std::string message;  ///< "scene.glb: found 3 indices, expected a multiple of 4"
};

/// A value, or the error that takes its place.
template <class T>
using Expected = tl::expected<T, Error>;

}  // namespace tenebra
