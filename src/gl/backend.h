// Inside of gl::Context: the functions that EGL, OSMesa and a window's context implement in their own ways.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "gl/context.h"
#include "gl/egl_choice.h"

namespace tenebra::gl {

struct Context::Backend {
  virtual ~Backend() = default;
  virtual bool make_current() = 0;
  virtual FunctionLoader loader() const = 0;
  virtual std::string_view kind_name() const = 0;

  std::string description;
  std::vector<std::string> debug_messages;
};

using BackendResult = Expected<std::unique_ptr<Context::Backend>>;

/// Not yet current. `device`: this alone; none: as Context::create says.
BackendResult create_egl_backend(ContextOptions options, std::optional<int> device);
BackendResult create_osmesa_backend(ContextOptions options);  ///< not yet current

/// A device or platform of EGL, and its context or what it lacks.
struct EglOffer {
  std::string name;
  EglPlatform kind;
  std::optional<int> device;
  BackendResult backend;
};
/// All of them, each with a context; none if there is no EGL.
std::deque<EglOffer> egl_offers();

/// Loads the functions of the context that is current and describes it; fails below OpenGL 4.5.
Expected<void> load_functions(Context::Backend& backend);
/// Sends the current context's complaints to backend.debug_messages.
void collect_debug_messages(Context::Backend& backend);

}  // namespace tenebra::gl
