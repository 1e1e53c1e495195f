#include "options/command_settings.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "options/output_table.h"

namespace tenebra::viewer {

using settings::About;

std::string long_name(std::string_view name) {
  return fmt::format("--{}", name);
}

std::string setting_of(const CLI::Option& option) {
  const auto& names = option.get_lnames();
  return names.empty() ? "" : names.front();
}

std::vector<const About*> settings_by(const CLI::App& command, const std::string& option) {
  std::vector<const About*> found;
  for (const CLI::Option* candidate : command.get_options()) {
    const About* about = about_of(setting_of(*candidate));
    if (about == nullptr) continue;
    const std::string as = settings::given_as(*about);
    if (as != long_name(about->name) + " " && as.starts_with(option + " ")) found.push_back(about);
  }
  return found;
}

CLI::Option* option_for(CLI::App& command, const About& about) {
  return command.get_option(long_name(about.name));
}

}  // namespace tenebra::viewer
