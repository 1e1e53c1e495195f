#include "options/config_file.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <vector>

#include "base/input_file.h"

namespace tenebra::viewer {
namespace {

constexpr std::size_t most_bytes = 1 << 20;

bool is_flag(const CLI::Option& option) {
  return option.get_expected_min() == 0;
}

/// Gives `option` the values of `item`, unless the command line gave it some.
void apply(CLI::Option& option, const CLI::ConfigItem& item) {
  if (!option.empty()) return;
  if (is_flag(option)) {
    option.add_result(option.get_flag_value(item.name, CLI::ConfigBase().to_flag(item)));
  } else if (option.get_expected_max() > 1) {
    option.add_result(item.inputs);
  } else {
    option.add_result(fmt::format("{}", fmt::join(item.inputs, ",")));  // 0,1,0 was taken for a list
  }
  option.run_callback();
}

/// Whether `item` is a setting of `command`: at the top of the file or in the command's own section.
bool concerns(const CLI::ConfigItem& item, const CLI::App& command) {
  const bool marks_section = item.name == "++" || item.name == "--";
  return !marks_section && (item.parents.empty() || item.parents.front() == command.get_name());
}

void read_config(CLI::App& command, const std::string& path) {
  const auto refuse = [&](const std::string& what) {
    throw CLI::ValidationError("--config", fmt::format("{}: {}", path, what));
  };
  const auto text = base::read_file(path, most_bytes);
  if (!text) throw CLI::ValidationError("--config", text.error().message);
  std::istringstream lines(*text);
  const std::vector<CLI::ConfigItem> items = CLI::ConfigBase().from_config(lines);
  for (const CLI::ConfigItem& item : items) {
    if (!concerns(item, command)) continue;
    CLI::Option* option = command.get_option_no_throw("--" + item.name);
    if (option == nullptr || item.name == "config" || item.name == "help") {
      refuse(fmt::format("found the name '{}', expected the long name of an option of tenebra {}",
                         item.fullname(), command.get_name()));
    }
    try {
      apply(*option, item);
    } catch (const CLI::Error& error) {
      refuse(error.what());
    }
  }
}

}  // namespace

void add_config_option(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--config", [&command](const std::string& path) { read_config(command, path); },
          "Read options from a file with lines like size = 800x600;\noptions on the command line win")
      ->type_name("FILE");
}

std::string config_file_of(const CLI::App& command) {
  const CLI::Option* option = command.get_option("--config");
  return option->empty() ? "" : option->as<std::string>();
}

}  // namespace tenebra::viewer
