#include "options/config_file.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

#include "io/input_file.h"
#include "options/setting_options.h"
#include "options/settings_names.h"
#include "settings/rows.h"
#include "shell/console.h"

namespace tenebra::viewer {
namespace {

constexpr std::size_t most_bytes = 1 << 20;
constexpr const char* config_option = "--config";

bool is_flag(const CLI::Option& option) {
  return option.get_expected_min() == 0;
}

/// Gives `option` the values of `item`, unless it has some, and its keys theirs, but for settings that the
/// command line gave.
void apply(CLI::App& command, CLI::Option& option, CLI::ConfigItem item, const settings::Given& given) {
  const auto is_key = [&](const std::string& text) {
    return read_key(command, option.get_name(), text, given);
  };
  item.inputs = with_whole_vectors(command, option.get_name(), item.inputs);
  const bool keys_alone =
      !item.inputs.empty() && std::erase_if(item.inputs, is_key) > 0 && item.inputs.empty();
  if (keys_alone || gives_itself(command, option)) return;
  option.clear();  // of the command line's keys, which have been read
  if (is_flag(option)) {
    const auto on = settings::parse_switch(CLI::ConfigBase().to_flag(item));
    if (!on) throw CLI::ValidationError(option.get_name(), on.error().message);
    option.add_result(*on ? "true" : "false");
  } else if (option.get_expected_max() > 1) {
    option.add_result(item.inputs);
  } else {
    option.add_result(fmt::format("{}", fmt::join(item.inputs, ",")));  // the parser took 0,1,0 for a list
  }
  option.run_callback();
}

/// The option that the key `name` sets, if there is one.
CLI::Option* option_of_key(CLI::App& command, const std::string& name) {
  if (name == "config" || name == "help") return nullptr;
  return command.get_option_no_throw("--" + name);
}

/// The commands that read files of options; each may have a section.
std::vector<CLI::App*> commands_with_config(CLI::App& command) {
  if (command.get_parent() == nullptr) return {&command};
  const auto reads = [](CLI::App* other) { return other->get_option_no_throw(config_option) != nullptr; };
  return command.get_parent()->get_subcommands(reads);
}

std::string unknown_key(CLI::App& command, const CLI::ConfigItem& item) {
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      if (!is_outdated(*option) && option_of_key(command, name) != nullptr) known.push_back(name);
  return fmt::format("found the name '{}', expected the long name of an option of tenebra {}{}",
                     item.fullname(), command.get_name(), settings::did_you_mean(item.name, known));
}

std::string unknown_section(const std::vector<CLI::App*>& commands, const CLI::ConfigItem& item) {
  std::vector<std::string> known;
  known.reserve(commands.size());
  for (const CLI::App* other : commands) known.push_back(other->get_name());
  return fmt::format("found the section [{}], expected [{}]{}", fmt::join(item.parents, "."),
                     fmt::join(known, "], ["), settings::did_you_mean(item.parents.front(), known, "[{}]"));
}

/// The command that `item` is for: `command` itself, or the one whose section it stands in; none: there is no
/// such section.
CLI::App* command_of(CLI::App& command, const std::vector<CLI::App*>& commands, const CLI::ConfigItem& item) {
  if (item.parents.empty()) return &command;
  const auto found = std::find_if(commands.begin(), commands.end(), [&](const CLI::App* other) {
    return item.parents.size() == 1 && item.parents.front() == other->get_name();
  });
  return found == commands.end() ? nullptr : *found;
}

std::vector<CLI::ConfigItem> read_items(const std::string& path) {
  const auto text = io::read_file(path, most_bytes);
  if (!text) throw CLI::ValidationError(config_option, text.error().message);
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // Windows' editors write it
  std::istringstream lines(text->substr(text->starts_with(byte_order_mark) ? byte_order_mark.size() : 0));
  return CLI::ConfigBase().from_config(lines);
}

void read_config(CLI::App& command, const std::string& path) {
  const auto refuse = [&](const std::string& what) {
    throw CLI::ValidationError(config_option, fmt::format("{}: {}", path, what));
  };
  const std::vector<CLI::App*> commands = commands_with_config(command);
  const settings::Given given = given_settings(command);
  for (const CLI::ConfigItem& item : read_items(path)) {
    CLI::App* const concerned = command_of(command, commands, item);
    if (concerned == nullptr) refuse(unknown_section(commands, item));
    const bool marks_section = item.name == "++" || item.name == "--";
    if (marks_section) continue;
    CLI::Option* const option = option_of_key(*concerned, item.name);
    if (option == nullptr) refuse(unknown_key(*concerned, item));
    if (concerned != &command) continue;
    if (is_outdated(*option) && !is_quiet(command)) print_warnings({outdated_sentence(item.name)});
    try {
      apply(command, *option, item, given);
    } catch (const CLI::Error& error) {
      refuse(error.what());
    }
  }
}

}  // namespace

void add_config_option(CLI::App& command) {
  command
      .add_option_function<std::string>(
          config_option, [&command](const std::string& path) { read_config(command, path); },
          "Read options from a file with lines like size = 800x600;\noptions on the command line win")
      ->type_name("FILE");
}

std::string config_file_of(const CLI::App& command) {
  const CLI::Option* option = command.get_option("--config");
  return option->empty() ? "" : option->as<std::string>();
}

}  // namespace tenebra::viewer
