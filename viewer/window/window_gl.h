// The little OpenGL that the window itself needs: pictures as textures, a clear, the window's pixels. Its
// functions are its own: the table of src/gl belongs to the render worker's thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "gl/context.h"
#include "io/image.h"

namespace tenebra::viewer {

/// Uses the context that is current on the calling thread; all of its textures live and die on that thread.
class WindowGl {
public:
  /// Fails below OpenGL 3.3. `debug`: collect what the driver complains about (needs a debug context).
  static Expected<WindowGl> load(gl::FunctionLoader loader, bool debug);
  WindowGl(WindowGl&&) noexcept;
  WindowGl& operator=(WindowGl&&) noexcept;
  ~WindowGl();

  void clear(int width, int height);                    ///< of the framebuffer, to the window's background
  io::Image8 read_window(int width, int height) const;  ///< RGB, row 0 at the top, of what was last drawn

  unsigned create_texture();
  /// RGB or RGBA. `smooth`: for pictures that are shown larger or smaller than they are.
  void upload(unsigned texture, const io::Image8& image, bool smooth);
  void delete_texture(unsigned texture);

  bool is_software() const;                  ///< it draws on the processors that pictures are computed on
  std::vector<std::string> take_messages();  ///< errors since the last call, glGetError's too

private:
  struct Functions;
  explicit WindowGl(std::unique_ptr<Functions> functions);
  std::unique_ptr<Functions> gl_;
};

/// A texture with the picture last given to it.
class PictureTexture {
public:
  explicit PictureTexture(WindowGl& gl) : gl_(gl), name_(gl.create_texture()) {}
  ~PictureTexture() { gl_.delete_texture(name_); }
  PictureTexture(const PictureTexture&) = delete;
  PictureTexture& operator=(const PictureTexture&) = delete;

  void show(const io::Image8& image, bool smooth) {
    gl_.upload(name_, image, smooth);
    width_ = image.width;
    height_ = image.height;
  }
  /// For ImGui. NOLINTNEXTLINE(performance-no-int-to-ptr)
  void* id() const { return reinterpret_cast<void*>(static_cast<std::uintptr_t>(name_)); }
  int width() const { return width_; }
  int height() const { return height_; }

private:
  WindowGl& gl_;
  unsigned name_;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace tenebra::viewer
