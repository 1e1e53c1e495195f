// What all passes do before and after they draw. Internal to raster.
#pragma once

#include "gl/objects.h"

namespace tenebra::raster {

/// Binds target and program and sets the state that a window's user may have changed.
void begin_pass(const gl::Framebuffer& target, const gl::Program& program, int width, int height);
/// Unbinds them and waits until the drawing is done.
void end_pass();

/// One triangle over the whole target, without depth test, for shaders/fullscreen.vert.
void draw_fullscreen(const gl::VertexArray& empty);
void bind_texture(unsigned unit, const gl::Texture& texture);

}  // namespace tenebra::raster
