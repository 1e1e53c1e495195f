// What people type before they know the commands.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tenebra::viewer {

/// The arguments behind the program's name, as the commands read them: "help", "help render" and "-V" as the
/// options that they mean, and a file or folder alone, or with options behind it, as "view FILE". A word of
/// `commands` is always that command.
std::vector<std::string> as_commands(std::vector<std::string> arguments,
                                     std::span<const std::string> commands);

}  // namespace tenebra::viewer
