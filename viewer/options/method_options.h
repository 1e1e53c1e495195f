// The options that choose how light is computed: shadows, their settings, ambient occlusion. `tenebra render`
// and `tenebra view` share them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "options/option_values.h"
#include "render/quality.h"
#include "shell/command_line.h"

namespace tenebra::viewer {

/// Samples a pixel of pictures; RenderSettings has 1, for those who ask for masks.
inline constexpr int standard_antialias = 4;

struct MethodOptions {
  render::RenderSettings render;                 ///< but for its size
  std::optional<render::Quality> quality;        ///< as given; settle_quality turns it into settings
  std::optional<bool> cull_front;                ///< not given: as the samples need it
  std::optional<LightSize> light_size;           ///< not given: points stay points
  std::optional<render::Terminator> terminator;  ///< not given: smooth
};

/// Adds the options to `command`; they are read into `options`, which must live as long.
void add_method_options(CLI::App& command, MethodOptions& options);

/// Sets what a given --quality stands for, but for options that `command` was given themselves: they win
/// wherever they stand, in a file of options too. To be called once all options are read.
void settle_quality(const CLI::App& command, MethodOptions& options);

/// What single options cannot check: combinations.
Expected<void> check_method_options(const MethodOptions& options);

/// Options given to `command` that the chosen methods do not look at, a sentence each.
std::vector<std::string> idle_method_options(const CLI::App& command, const MethodOptions& options);

/// The settings of a frame of `size`.
render::RenderSettings method_settings(const MethodOptions& options, Size size);

}  // namespace tenebra::viewer
