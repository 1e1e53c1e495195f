#include "shell/first_words.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace tenebra::viewer {

std::vector<std::string> as_commands(std::vector<std::string> arguments,
                                     std::span<const std::string> commands) {
  if (arguments.empty()) return arguments;
  const std::string first = arguments.front();
  if (first == "-V") arguments.front() = "--version";
  if (first == "help") {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  const bool is_command = std::find(commands.begin(), commands.end(), first) != commands.end();
  std::error_code none;
  if (!is_command && !first.empty() && first.front() != '-' && std::filesystem::exists(first, none))
    arguments.insert(arguments.begin(), "view");
  return arguments;
}

}  // namespace tenebra::viewer
