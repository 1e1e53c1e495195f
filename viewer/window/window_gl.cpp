#include "window/window_gl.h"

#include "base/fail.h"
#include "gl/renderer_name.h"

#include <glad/gl.h>  // types and constants; the calls go through Functions

#include <algorithm>
#include <utility>

namespace tenebra::viewer {

struct WindowGl::Functions {
  PFNGLGETERRORPROC get_error = nullptr;
  PFNGLGETINTEGERVPROC get_integer = nullptr;
  PFNGLGETSTRINGPROC get_string = nullptr;
  PFNGLVIEWPORTPROC viewport = nullptr;
  PFNGLCLEARCOLORPROC clear_color = nullptr;
  PFNGLCLEARPROC clear = nullptr;
  PFNGLREADPIXELSPROC read_pixels = nullptr;
  PFNGLPIXELSTOREIPROC pixel_store = nullptr;
  PFNGLGENTEXTURESPROC gen_textures = nullptr;
  PFNGLDELETETEXTURESPROC delete_textures = nullptr;
  PFNGLBINDTEXTUREPROC bind_texture = nullptr;
  PFNGLTEXPARAMETERIPROC tex_parameter = nullptr;
  PFNGLTEXIMAGE2DPROC tex_image = nullptr;
  PFNGLENABLEPROC enable = nullptr;
  PFNGLDEBUGMESSAGECALLBACKPROC debug_message_callback = nullptr;
  std::vector<std::string> messages;
};

namespace {

constexpr float background[3] = {0.035f, 0.038f, 0.047f};

template <class Pointer>
void find(gl::FunctionLoader loader, const char* name, Pointer& function) {
  function = reinterpret_cast<Pointer>(loader(name));
}

void GLAD_API_PTR on_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length,
                             const GLchar* message, const void* user) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_PERFORMANCE) return;
  static_cast<std::vector<std::string>*>(const_cast<void*>(user))
      ->emplace_back(message, static_cast<std::size_t>(length));
}

}  // namespace

WindowGl::WindowGl(std::unique_ptr<Functions> functions) : gl_(std::move(functions)) {}
WindowGl::WindowGl(WindowGl&&) noexcept = default;
WindowGl& WindowGl::operator=(WindowGl&&) noexcept = default;
WindowGl::~WindowGl() = default;

Expected<WindowGl> WindowGl::load(gl::FunctionLoader loader, bool debug) {
  auto gl = std::make_unique<Functions>();
  find(loader, "glGetError", gl->get_error);
  find(loader, "glGetIntegerv", gl->get_integer);
  find(loader, "glGetString", gl->get_string);
  find(loader, "glViewport", gl->viewport);
  find(loader, "glClearColor", gl->clear_color);
  find(loader, "glClear", gl->clear);
  find(loader, "glReadPixels", gl->read_pixels);
  find(loader, "glPixelStorei", gl->pixel_store);
  find(loader, "glGenTextures", gl->gen_textures);
  find(loader, "glDeleteTextures", gl->delete_textures);
  find(loader, "glBindTexture", gl->bind_texture);
  find(loader, "glTexParameteri", gl->tex_parameter);
  find(loader, "glTexImage2D", gl->tex_image);
  find(loader, "glEnable", gl->enable);
  find(loader, "glDebugMessageCallback", gl->debug_message_callback);
  if (!gl->get_integer)
    return base::fail("the window's OpenGL context has no functions; tenebra render needs no window");
  GLint major = 0, minor = 0;
  gl->get_integer(GL_MAJOR_VERSION, &major);
  gl->get_integer(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 33) {
    return base::fail(
        "the window's OpenGL is version {}.{}, expected 3.3 or newer; tenebra render needs no window", major,
        minor);
  }
  if (debug && gl->debug_message_callback) {
    gl->enable(GL_DEBUG_OUTPUT);
    gl->enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    gl->debug_message_callback(on_message, &gl->messages);
  }
  return WindowGl(std::move(gl));
}

void WindowGl::clear(int width, int height) {
  gl_->viewport(0, 0, width, height);
  gl_->clear_color(background[0], background[1], background[2], 1);
  gl_->clear(GL_COLOR_BUFFER_BIT);
}

io::Image8 WindowGl::read_window(int width, int height) const {
  const auto row = static_cast<std::size_t>(width) * 3;
  io::Image8 image{width, height, 3, std::vector<std::uint8_t>(row * static_cast<std::size_t>(height))};
  gl_->pixel_store(GL_PACK_ALIGNMENT, 1);
  gl_->read_pixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
  for (int y = 0; y < height / 2; ++y) {
    const auto top = image.pixels.begin() + static_cast<std::ptrdiff_t>(row) * y;
    const auto bottom = image.pixels.begin() + static_cast<std::ptrdiff_t>(row) * (height - 1 - y);
    std::swap_ranges(top, top + static_cast<std::ptrdiff_t>(row), bottom);
  }
  return image;
}

unsigned WindowGl::create_texture() {
  GLuint name = 0;
  gl_->gen_textures(1, &name);
  return name;
}

void WindowGl::delete_texture(unsigned texture) {
  gl_->delete_textures(1, &texture);
}

void WindowGl::upload(unsigned texture, const io::Image8& image, bool smooth) {
  const GLenum format = image.channels == 4 ? GL_RGBA : GL_RGB;
  const GLint filter = smooth ? GL_LINEAR : GL_NEAREST;
  gl_->bind_texture(GL_TEXTURE_2D, texture);
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    gl_->tex_parameter(GL_TEXTURE_2D, name, filter);
  }
  for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    gl_->tex_parameter(GL_TEXTURE_2D, name, GL_CLAMP_TO_EDGE);
  }
  gl_->pixel_store(GL_UNPACK_ALIGNMENT, 1);
  gl_->pixel_store(GL_UNPACK_ROW_LENGTH, 0);
  gl_->tex_image(GL_TEXTURE_2D, 0, image.channels == 4 ? GL_RGBA8 : GL_RGB8, image.width, image.height, 0,
                 format, GL_UNSIGNED_BYTE, image.pixels.data());
}

bool WindowGl::is_software() const {
  const GLubyte* name = gl_->get_string ? gl_->get_string(GL_RENDERER) : nullptr;
  return name && gl::is_software_renderer(reinterpret_cast<const char*>(name));
}

std::vector<std::string> WindowGl::take_messages() {
  std::vector<std::string> messages = std::exchange(gl_->messages, {});
  for (GLenum error = gl_->get_error(); error != GL_NO_ERROR; error = gl_->get_error()) {
    messages.push_back(fmt::format("OpenGL error {:#x} in the window", error));
    if (messages.size() > 16) break;  // a lost context answers for ever
  }
  return messages;
}

}  // namespace tenebra::viewer
