// What GL_RENDERER says about where OpenGL draws.
#pragma once

#include <string_view>

namespace tenebra::gl {

/// Whether GL_RENDERER names a renderer that runs on the CPU.
bool is_software_renderer(std::string_view gl_renderer);

}  // namespace tenebra::gl
