// Offscreen OpenGL contexts: EGL surfaceless or OSMesa, chosen at run time; or one adopted from a window.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/expected.h"

namespace tenebra::gl {

enum class ContextKind { automatic, egl, osmesa };
std::optional<ContextKind> context_kind_from_name(std::string_view name);  ///< auto, egl, osmesa

/// An OpenGL 4.5 core context, current on the thread that made it, with its functions loaded.
class Context {
 public:
  /// automatic: EGL surfaceless, else OSMesa. Fails with a sentence that names what each lacked.
  static Expected<Context> create(ContextKind kind);
  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;
  ~Context();

  std::string_view kind_name() const;       ///< "egl", "osmesa" or "window"
  const std::string& description() const;   ///< GL_RENDERER, GL_VERSION

  struct Backend;
  explicit Context(std::unique_ptr<Backend> backend);

 private:
  std::unique_ptr<Backend> backend_;
};

}  // namespace tenebra::gl
