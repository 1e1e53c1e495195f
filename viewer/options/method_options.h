// The options that choose how light is computed: shadows, their settings, ambient occlusion. The commands
// render, view and trade share them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "options/option_values.h"
#include "render/quality.h"
#include "settings/method_settings.h"
#include "shell/command_line.h"

namespace tenebra::viewer {

/// Samples per pixel of pictures; RenderSettings has 1, for callers that want masks.
inline constexpr int standard_antialias = 4;

using settings::AutoExposures;
using settings::SceneDisplay;

struct MethodOptions {
  render::RenderSettings render;                 ///< but for its size, tone and emission
  std::optional<render::Quality> quality;        ///< as given; settle_quality turns it into settings
  std::optional<bool> cull_front;                ///< not given: as the samples need it
  std::optional<LightSize> light_size;           ///< not given: points stay points
  std::optional<render::Terminator> terminator;  ///< not given: smooth
  render::LightEmission light_emission = render::LightEmission::point;  ///< in place of render's
  std::optional<shade::Tone> tone;  ///< not given: neutral for linear colours, none for display values
  bool auto_exposure = false;       ///< SceneDisplay::exposures, where measured, in place of render's
};

/// Adds the options to `command`; they are read into `options`, which must live as long.
void add_method_options(CLI::App& command, MethodOptions& options);

/// Of these only what chooses how hard masks are traced: --light, --variant, --cull, --threads, --simd.
void add_tracer_options(CLI::App& command, MethodOptions& options);
/// --shadows, what gives lights an area, and what chooses how their visible part is found.
void add_soft_tracer_options(CLI::App& command, MethodOptions& options);

constexpr std::size_t bytes_of_mb(int mb) {
  return static_cast<std::size_t>(mb) << 20;
}
/// Adds --soft-memory to `command`, which sets soft as set_soft_memory() does.
AddedOption add_soft_memory(CLI::App& command, SoftShadowConfig& soft, const char* help);

/// --soft-memory: that much for soft shadows, and BSPs of any size within it.
void set_soft_memory(int mb, SoftShadowConfig& soft);
/// What was given to it; none: nothing.
std::optional<int> soft_memory_mb(const SoftShadowConfig& soft);

/// Sets what a given --quality stands for, but for options that `command` was given themselves: they win
/// wherever they stand, in a file of options too. To be called once all options are read.
void settle_quality(const CLI::App& command, MethodOptions& options);

/// What single options cannot check: combinations.
Expected<void> check_method_options(const MethodOptions& options);

/// Options given to `command` that the chosen methods ignore, one sentence each.
std::vector<std::string> idle_method_options(const CLI::App& command, const MethodOptions& options);

/// The tone of pictures with that transfer.
shade::Tone tone_of(const MethodOptions& options, Transfer transfer);

/// The settings of a frame of `size`.
render::RenderSettings method_settings(const MethodOptions& options, Size size, const SceneDisplay& display);

}  // namespace tenebra::viewer
