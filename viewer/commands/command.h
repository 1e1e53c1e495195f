// The interface between main and the commands of `tenebra`.
#pragma once

#include "shell/command_line.h"

namespace tenebra::viewer {

/// Runs the chosen command once its options are read: the exit code, or one sentence of what went wrong.
using Run = std::function<Expected<int>()>;

/// Each adds one command to `program`, its options and its help, and sets `run` when the user chose it.
void add_view_command(CLI::App& program, Run& run);
void add_render_command(CLI::App& program, Run& run);
void add_info_command(CLI::App& program, Run& run);
void add_convert_command(CLI::App& program, Run& run);
void add_bake_command(CLI::App& program, Run& run);
void add_sun_command(CLI::App& program, Run& run);
void add_compare_command(CLI::App& program, Run& run);
void add_log_command(CLI::App& program, Run& run);
void add_verify_command(CLI::App& program, Run& run);
void add_trade_command(CLI::App& program, Run& run);

}  // namespace tenebra::viewer
