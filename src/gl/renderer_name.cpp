#include "gl/renderer_name.h"

#include <algorithm>
#include <array>

namespace tenebra::gl {

bool is_software_renderer(std::string_view gl_renderer) {
  constexpr std::array<std::string_view, 7> names{
      "llvmpipe", "softpipe", "swrast", "SWR", "lavapipe", "Software Rasterizer", "SwiftShader"};
  return std::any_of(names.begin(), names.end(),
                     [&](std::string_view name) { return gl_renderer.find(name) != std::string_view::npos; });
}

}  // namespace tenebra::gl
