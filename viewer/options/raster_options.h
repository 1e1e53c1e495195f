// The options that choose who finds the triangle that each pixel sees, and who makes the colours. The
// commands render, view, verify and trade share them.
#pragma once

#include <array>
#include <string>

#include "render/frame_raster.h"
#include "shell/command_line.h"

namespace tenebra::viewer {

/// Adds --raster, --shading and --context to `command`; they are read into `choice`, which must live as long.
std::array<AddedOption, 3> add_raster_options(CLI::App& command, render::RasterChoice& choice);

/// What drew, for logs.
struct RasterNames {
  std::string raster;    ///< "gl" or "cpu"
  std::string shading;   ///< likewise: who makes the colours, where it can
  std::string renderer;  ///< FrameRaster::gl_renderer
};
RasterNames raster_names(const render::FrameRaster& raster);

}  // namespace tenebra::viewer
