// The options of `tenebra render`: scene and method as every command has them, and the files it writes.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "options/method_options.h"
#include "options/picture_options.h"
#include "options/scene_options.h"
#include "options/settings_names.h"

namespace tenebra::viewer {

struct RenderOptions {
  SceneOptions scene;
  MethodOptions method;
  std::optional<FrameRange> frames;
  render::RasterChoice raster;

  PictureOptions pictures;
  std::vector<OutputPattern> masks;         ///< .png or .pfm
  std::vector<OutputPattern> mask_colours;  ///< the same, of masks times the tint of see-through surfaces
  std::vector<OutputPattern> mask_means;    ///< of the samples of --antialias
  std::vector<OutputPattern> mask_samples;  ///< .png: each of them
  std::vector<OutputPattern> error_maps;    ///< .png or .pfm
  std::string log;
  std::string trace;
  std::string config;  ///< the file that options came from; empty: none
  double timeout_s = std::numeric_limits<double>::infinity();  ///< for the whole run
  std::optional<double> budget_ms;                             ///< of a frame
  std::optional<int> memory_mb;                                ///< of the whole program
  Chunk chunk;                                                 ///< of the frames
  bool resume = false;  ///< frames that were drawn with the same settings are not drawn again
  bool quiet = false;
  std::vector<std::string> warnings;  ///< options that do nothing with the others
};

/// Adds the options to `command`; they are read into `options`, which must live as long.
void add_render_options(CLI::App& command, RenderOptions& options);

/// Sets what follows from other options: masks keep the bits that they always had, so what makes them starts
/// on the triangles unless --terminator is given. To be called once all options are read.
void settle_render_options(RenderOptions& options);

/// What single options cannot check: combinations.
Expected<void> check_render_options(const RenderOptions& options);

}  // namespace tenebra::viewer
