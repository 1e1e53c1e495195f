#include "options/raster_options.h"

#include "base/fail.h"
#include "options/settings_names.h"

namespace tenebra::viewer {
namespace {

constexpr std::array raster_choices{Choice<render::RasterKind>{"auto", render::RasterKind::automatic},
                                    Choice<render::RasterKind>{"gl", render::RasterKind::gl},
                                    Choice<render::RasterKind>{"cpu", render::RasterKind::cpu}};

Expected<render::RasterKind> parse_raster(const std::string& text) {
  return parse_choice(raster_choices, text);
}

Expected<gl::ContextChoice> parse_context(const std::string& text) {
  if (const auto choice = gl::context_choice_from_name(lower_case(text))) return *choice;
  return base::fail("found {}, expected auto, egl, egl:N or osmesa", text);
}

}  // namespace

std::array<AddedOption, 3> add_raster_options(CLI::App& command, render::RasterChoice& choice) {
  return {add_value(command, "--raster", choice.kind, parse_raster,
                    "How the triangle that each pixel sees is found: by OpenGL,\n"
                    "or by the CPU, exactly and without OpenGL [auto: OpenGL on\n"
                    "a GPU, else the CPU]")
              .type_name("auto|gl|cpu"),
          add_value(command, "--shading", choice.shading, parse_raster,
                    "Who makes the colours of what is seen from light and\n"
                    "shadows: the CPU, or OpenGL but for what it cannot make yet\n"
                    "[auto: the CPU]")
              .type_name("auto|gl|cpu"),
          add_value(command, "--context", choice.context, parse_context,
                    "Offscreen OpenGL for the above; egl:N is device N of\n"
                    "tenebra info --gl [auto: a GPU by EGL, else software by EGL,\n"
                    "else OSMesa]")
              .type_name("auto|egl|egl:N|osmesa")};
}

RasterNames raster_names(const render::FrameRaster& raster) {
  return {raster.is_gl() ? "gl" : "cpu", raster.shades_by_gl() ? "gl" : "cpu", raster.gl_renderer()};
}

}  // namespace tenebra::viewer
