// The one instance of the OpenGL loader, and the messages of KHR_debug.
#define GLAD_GL_IMPLEMENTATION
#include <glad/gl.h>

#include "gl/backend.h"

#include "base/fail.h"

#include <mutex>

namespace tenebra::gl {
namespace {

constexpr int least_version = GLAD_MAKE_VERSION(4, 5);

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "unnamed";
}

void GLAD_API_PTR on_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length,
                             const GLchar* message, const void* user) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_PERFORMANCE) return;
  auto* backend = static_cast<Context::Backend*>(const_cast<void*>(user));
  backend->debug_messages.emplace_back(message, static_cast<std::size_t>(length));
}

/// The version of the context that is current; 0: there are no functions. glad's pointers are one table for
/// all threads, and contexts are made current before each frame: to write the same values again would race
/// with a thread that draws (a search for settings makes renderers while the viewer's worker draws). So a
/// table that a loader has filled stays until another loader comes. It serves all contexts of that loader:
/// what eglGetProcAddress, glXGetProcAddress and OSMesaGetProcAddress return does not depend on the context.
/// Contexts of two libraries on two threads at once are beyond one table.
int fill_table(FunctionLoader loader) {
  static std::mutex mutex;
  static FunctionLoader filled_by = nullptr;
  const std::lock_guard lock(mutex);
  if (filled_by == loader) {
    GLint major = 0, minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    return GLAD_MAKE_VERSION(major, minor);
  }
  const int version = gladLoadGL(loader);
  filled_by = version >= least_version ? loader : nullptr;  // of an older context the table has gaps
  return version;
}

}  // namespace

Expected<void> load_functions(Context::Backend& backend) {
  const int version = fill_table(backend.loader());
  if (version == 0)
    return base::fail(ErrorKind::device, "OpenGL context {}: found no OpenGL functions", backend.kind_name());
  backend.description = fmt::format("{}, OpenGL {}", gl_string(GL_RENDERER), gl_string(GL_VERSION));
  if (version >= least_version) return {};
  return base::fail(ErrorKind::device, "OpenGL context {} ({}): found version {}.{}, expected 4.5 or newer",
                    backend.kind_name(), backend.description, GLAD_VERSION_MAJOR(version),
                    GLAD_VERSION_MINOR(version));
}

void collect_debug_messages(Context::Backend& backend) {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(on_message, &backend);
}

}  // namespace tenebra::gl
