// Which settings of the tables a command has, and the options that they are.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "settings/tables.h"
#include "shell/command_line.h"

namespace tenebra::viewer {

inline constexpr const char* paper_option = "--paper";

/// "--soft-error" of "soft-error".
std::string long_name(std::string_view name);
/// "soft-error" of the option --soft-error; empty: it has no long name.
std::string setting_of(const CLI::Option& option);
/// Those that keys of `option` give, by hidden options of their own.
std::vector<const settings::About*> settings_by(const CLI::App& command, const std::string& option);
/// The option of `command` for a setting that it has.
CLI::Option* option_for(CLI::App& command, const settings::About& about);

}  // namespace tenebra::viewer
