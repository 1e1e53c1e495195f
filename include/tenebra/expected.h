// The result of calls that can fail for outside reasons: files, imports, contexts, shaders, output.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace tenebra {

/// Why a call has no result: what a program can act on without reading the sentence.
enum class ErrorKind {
  input,    ///< what the caller gave: an option, a scene, a picture
  stopped,  ///< the caller asked for the end
  memory,   ///< there is no room, or a bound on it leaves none
  device,   ///< OpenGL: no context, its driver, a shader
  file      ///< the system could not read or write
};

/// What kept a call from its result.
struct Error {
  /// One sentence for a person to read: the place (file, line or stage), what was found, what was expected:
  /// "scene.glb: found 3 indices, expected a multiple of 4".
  std::string message;
  ErrorKind kind = ErrorKind::input;  ///< for programs
};

/// Whether the call ended because somebody asked for it.
inline bool is_stop(const Error& error) {
  return error.kind == ErrorKind::stopped;
}

/// A value, or the error that takes its place.
template <class T>
using Expected = tl::expected<T, Error>;

/// Whether a call ended because somebody asked for it.
template <class T>
bool is_stop(const Expected<T>& result) {
  return !result && is_stop(result.error());
}

}  // namespace tenebra
