// Set-up and clean-up of a pass. Internal to raster.
#pragma once

#include "gl/objects.h"

namespace tenebra::raster {

/// Binds target and program and sets the state that a window's user may have changed.
void begin_pass(const gl::Framebuffer& target, const gl::Program& program, int width, int height);
/// Unbinds them and waits until the drawing is done.
void end_pass();

}  // namespace tenebra::raster
