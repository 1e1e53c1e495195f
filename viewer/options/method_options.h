// The options that choose how light is computed: shadows, their settings, ambient occlusion. The commands
// render, view and trade share them.
#pragma once

#include <string>
#include <vector>

#include "options/setting_options.h"
#include "options/settings_names.h"

namespace tenebra::viewer {

/// Adds the options to `command`; they are read into `options`, which must live as long.
void add_method_options(CLI::App& command, MethodOptions& options);

/// Of these only what chooses how masks and visible fractions are traced.
void add_tracer_options(CLI::App& command, MethodOptions& options);

/// Sets what a given --quality stands for, but for options that `command` was given themselves: they win
/// wherever they stand, in a file of options too. To be called once all options are read.
void settle_quality(const CLI::App& command, MethodOptions& options);

/// Options given to `command` that the chosen methods ignore, one sentence each.
std::vector<std::string> idle_method_options(const CLI::App& command, const MethodOptions& options);

}  // namespace tenebra::viewer
