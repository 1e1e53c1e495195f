// The kinds of OpenGL contexts that this machine can have.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "gl/context.h"

namespace tenebra::gl {

inline void PrintTo(ContextKind kind, std::ostream* out) {  // CTest's name of the test
  *out << (kind == ContextKind::egl ? "egl" : kind == ContextKind::osmesa ? "osmesa" : "auto");
}

}  // namespace tenebra::gl

namespace tenebra::test {

/// Mesa 25.1 and later come without OSMesa. One that is there and does not work is a failure, no absence.
inline bool osmesa_is_missing() {
  static const bool missing = [] {
    const auto context = gl::Context::create(gl::ContextKind::osmesa);
    return !context && context.error().message.find("found none of libOSMesa") != std::string::npos;
  }();
  return missing;
}

/// A kind that can always be had: what stands in for the context of a window.
inline gl::ContextKind any_kind() {
  return osmesa_is_missing() ? gl::ContextKind::egl : gl::ContextKind::osmesa;
}

}  // namespace tenebra::test

/// In a test or its SetUp: leaves it where `kind` is OSMesa and there is none.
#define TENEBRA_NEEDS_CONTEXT(kind)                                                         \
  if ((kind) == ::tenebra::gl::ContextKind::osmesa && ::tenebra::test::osmesa_is_missing()) \
  GTEST_SKIP() << "this system has no libOSMesa; EGL is tested alone"
