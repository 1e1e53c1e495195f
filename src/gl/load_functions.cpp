// The one instance of the OpenGL loader, and the messages of KHR_debug.
#define GLAD_GL_IMPLEMENTATION
#include <glad/gl.h>

#include "gl/backend.h"

#include "base/fail.h"

namespace tenebra::gl {
namespace {

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

}  // namespace

Expected<void> load_functions(Context::Backend& backend) {
  const int version = gladLoadGL(backend.loader());
  if (version == 0) return base::fail("OpenGL context {}: found no OpenGL functions", backend.kind_name());
  backend.description = fmt::format("{}, OpenGL {}", gl_string(GL_RENDERER), gl_string(GL_VERSION));
  const int major = GLAD_VERSION_MAJOR(version), minor = GLAD_VERSION_MINOR(version);
  if (major > 4 || (major == 4 && minor >= 5)) return {};
  return base::fail("OpenGL context {} ({}): found version {}.{}, expected 4.5 or newer", backend.kind_name(),
                    backend.description, major, minor);
}

void collect_debug_messages(Context::Backend& backend) {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(on_message, &backend);
}

}  // namespace tenebra::gl
