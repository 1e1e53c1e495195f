// --memory: a bound on the whole program, and what follows from it.
#pragma once

#include <optional>

#include "options/method_options.h"

namespace tenebra::viewer {

inline constexpr const char* memory_help =
    "Memory for the whole program, in MB; if it needs more,\n"
    "it ends with a message [what the system has]";

/// Adds it to `command`; MB of 2^20 bytes, none: what the system has.
AddedOption add_memory_option(CLI::App& command, std::optional<int>& memory_mb,
                              const char* help = memory_help);

/// Where --memory is given and --ao-memory is not, fields and surface samples take a quarter of it at most,
/// and no more than they take without it. In the same way soft shadows take at most half without
/// --soft-memory. To be called once all options are read.
void settle_memory(const CLI::App& command, std::optional<int> memory_mb, MethodOptions& method);

}  // namespace tenebra::viewer
