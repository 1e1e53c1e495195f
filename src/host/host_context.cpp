// Reads a host's textures by functions of its own context: glad gives their types, none of its tables is
// used, so that a host may link its own.
#include <glad/gl.h>

#include <array>

#include <tenebra/host_frame.h>
#include "base/fail.h"
#include "host/host_rows.h"

namespace tenebra {

struct HostContext::Functions {
  PFNGLGETINTEGERVPROC get_integer = nullptr;
  PFNGLISTEXTUREPROC is_texture = nullptr;
  PFNGLGETTEXTUREPARAMETERIVPROC texture_parameter = nullptr;
  PFNGLGETTEXTURELEVELPARAMETERIVPROC level_parameter = nullptr;
  PFNGLGETTEXTUREIMAGEPROC texture_image = nullptr;
  PFNGLPIXELSTOREIPROC pixel_store = nullptr;
  PFNGLBINDBUFFERPROC bind_buffer = nullptr;
};

namespace {

template <class Pointer>
bool find(GlFunctionLoader loader, const char* name, Pointer& function) {
  function = reinterpret_cast<Pointer>(loader(name));
  return function != nullptr;
}

/// How pixels are packed into memory: tightly, into the caller's; as it was when this goes.
template <class Functions>
class TightPacking {
public:
  explicit TightPacking(const Functions& gl) : gl_(gl) {
    gl_.get_integer(GL_PIXEL_PACK_BUFFER_BINDING, &buffer_);
    gl_.bind_buffer(GL_PIXEL_PACK_BUFFER, 0);
    for (std::size_t i = 0; i < names.size(); ++i) {
      gl_.get_integer(names[i], &found_[i]);
      gl_.pixel_store(names[i], names[i] == GL_PACK_ALIGNMENT ? 1 : 0);
    }
  }
  TightPacking(const TightPacking&) = delete;
  TightPacking& operator=(const TightPacking&) = delete;
  ~TightPacking() {
    for (std::size_t i = 0; i < names.size(); ++i) gl_.pixel_store(names[i], found_[i]);
    gl_.bind_buffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(buffer_));
  }

private:
  static constexpr std::array<GLenum, 8> names{GL_PACK_SWAP_BYTES,   GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH,
                                               GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS,
                                               GL_PACK_SKIP_IMAGES,  GL_PACK_ALIGNMENT};
  const Functions& gl_;
  GLint buffer_ = 0;
  std::array<GLint, names.size()> found_{};
};

struct TextureSize {
  int width = 0;
  int height = 0;
  unsigned format = 0;
};

/// Asks only what no texture answers with an error: the host's error flag stays as it is.
template <class Functions>
Expected<TextureSize> size_of(const Functions& gl, unsigned texture, const char* what) {
  if (gl.is_texture(texture) == GL_FALSE)
    return base::fail("host's texture of {}: found the name {}, which is no texture", what, texture);
  GLint target = 0, width = 0, height = 0, format = 0;
  gl.texture_parameter(texture, GL_TEXTURE_TARGET, &target);
  if (target != GL_TEXTURE_2D && target != GL_TEXTURE_RECTANGLE)
    return base::fail("host's texture of {}: found the target {:#x}, expected GL_TEXTURE_2D", what, target);
  gl.level_parameter(texture, 0, GL_TEXTURE_WIDTH, &width);
  gl.level_parameter(texture, 0, GL_TEXTURE_HEIGHT, &height);
  gl.level_parameter(texture, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
  if (width < 1 || height < 1)
    return base::fail("host's texture of {}: found size {}x{}, expected at least 1x1", what, width, height);
  if (std::int64_t{width} * height >= std::int64_t{1} << 29)
    return base::fail("host's texture of {}: found size {}x{}, expected less than 2 GiB", what, width,
                      height);
  return TextureSize{width, height, static_cast<unsigned>(format)};
}

bool is_depth(unsigned format) {
  constexpr std::array<unsigned, 8> formats{GL_DEPTH_COMPONENT,   GL_DEPTH_COMPONENT16,  GL_DEPTH_COMPONENT24,
                                            GL_DEPTH_COMPONENT32, GL_DEPTH_COMPONENT32F, GL_DEPTH_STENCIL,
                                            GL_DEPTH24_STENCIL8,  GL_DEPTH32F_STENCIL8};
  for (const unsigned known : formats)
    if (format == known) return true;
  return false;
}

template <class Functions, class T>
void read_pixels(const Functions& gl, unsigned texture, const TextureSize& size, GLenum format, GLenum type,
                 std::vector<T>& out) {
  out.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  gl.texture_image(texture, 0, format, type, static_cast<GLsizei>(sizeof(T) * out.size()), out.data());
}

}  // namespace

HostContext::HostContext(std::unique_ptr<Functions> functions) : functions_(std::move(functions)) {}
HostContext::HostContext(HostContext&&) noexcept = default;
HostContext& HostContext::operator=(HostContext&&) noexcept = default;
HostContext::~HostContext() = default;

Expected<HostContext> HostContext::adopt(GlFunctionLoader loader) {
  auto gl = std::make_unique<Functions>();
  if (!find(loader, "glGetIntegerv", gl->get_integer))
    return base::fail("host's context: found no OpenGL functions");
  GLint major = 0, minor = 0;
  gl->get_integer(GL_MAJOR_VERSION, &major);
  gl->get_integer(GL_MINOR_VERSION, &minor);
  if (major == 0) return base::fail("host's context: found none that is current on this thread");
  if (major < 4 || (major == 4 && minor < 5))
    return base::fail("host's context: found OpenGL {}.{}, expected 4.5 or newer", major, minor);
  const bool complete = find(loader, "glIsTexture", gl->is_texture) &&
                        find(loader, "glGetTextureParameteriv", gl->texture_parameter) &&
                        find(loader, "glGetTextureLevelParameteriv", gl->level_parameter) &&
                        find(loader, "glGetTextureImage", gl->texture_image) &&
                        find(loader, "glPixelStorei", gl->pixel_store) &&
                        find(loader, "glBindBuffer", gl->bind_buffer);
  if (!complete) return base::fail("host's context: found a loader that lacks functions of OpenGL 4.5");
  return HostContext(std::move(gl));
}

Expected<void> HostContext::read(const HostTextures& textures, const HostLayout& layout,
                                 HostFrame& out) const {
  const Functions& gl = *functions_;
  const auto ids = size_of(gl, textures.ids, "ids");
  if (!ids) return tl::unexpected(ids.error());
  if (ids->format != GL_R32UI)
    return base::fail("host's texture of ids: found the format {:#x}, expected GL_R32UI", ids->format);
  const auto depth =
      textures.depth != 0 ? size_of(gl, textures.depth, "depth") : Expected<TextureSize>(TextureSize{});
  if (!depth) return tl::unexpected(depth.error());
  const bool wanted = textures.depth != 0;
  if (wanted && (depth->width != ids->width || depth->height != ids->height))
    return base::fail("host's texture of depth: found size {}x{}, expected that of the ids, {}x{}",
                      depth->width, depth->height, ids->width, ids->height);
  if (wanted && depth->format != GL_R32F && !is_depth(depth->format))
    return base::fail("host's texture of depth: found the format {:#x}, expected a depth format or GL_R32F",
                      depth->format);
  out.width = ids->width;
  out.height = ids->height;
  out.depth.clear();
  const TightPacking<Functions> packing(gl);
  read_pixels(gl, textures.ids, *ids, GL_RED_INTEGER, GL_UNSIGNED_INT, out.ids);
  if (wanted)
    read_pixels(gl, textures.depth, *depth, depth->format == GL_R32F ? GL_RED : GL_DEPTH_COMPONENT, GL_FLOAT,
                out.depth);
  host::arrange(layout, out);
  return {};
}

}  // namespace tenebra
