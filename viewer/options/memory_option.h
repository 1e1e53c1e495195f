// --memory: a bound on the whole program, and what follows from it.
#pragma once

#include <optional>

#include "options/method_options.h"

namespace tenebra::viewer {

/// Adds it to a command without the output table, with the keys of the settings that `command` has; MB of
/// 2^20 bytes, none: what the system has.
AddedOption add_memory_option(
    CLI::App& command, std::optional<int>& memory_mb,
    const char* help = "Memory for the whole program, in MB; if it needs more, it ends with a message");

/// Where --memory is given and --memory ao:MB is not, fields and surface samples take a quarter of it at
/// most, and no more than they take without it. In the same way soft shadows take at most half without
/// --memory soft:MB. To be called once all options are read.
void settle_memory(const CLI::App& command, std::optional<int> memory_mb, MethodOptions& method);

}  // namespace tenebra::viewer
