// Rows of the tables of settings as options of a command.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "settings/tables.h"
#include "shell/command_line.h"

namespace tenebra::viewer {

/// Reads all texts that were given to an option.
using ReadTexts = std::function<Expected<void>(const std::vector<std::string>&)>;

/// Lines as the help has them.
std::string wrapped(std::string_view text);

/// Adds one: `standard` is what the help writes for its default. Settings that are given by keys of another
/// option are hidden.
AddedOption add_setting(CLI::App& command, const settings::About& about, const std::string& standard,
                        ReadTexts read);
/// Adds --paper KEY=VALUE for the hidden settings that `command` has so far, and what settings need of each
/// other. Once for each command.
void complete_settings(CLI::App& command);

/// Adds the rows of `names` (none: all), read into `part`, which must live as long as `command`.
template <class Part>
void add_settings(CLI::App& command, std::span<const settings::Setting<Part>> table, Part& part,
                  std::initializer_list<std::string_view> names = {}) {
  for (const settings::Setting<Part>& setting : table) {
    if (names.size() > 0 && std::find(names.begin(), names.end(), setting.name) == names.end()) continue;
    const auto read = [&setting, &part](const std::vector<std::string>& texts) -> Expected<void> {
      for (const std::string& text : texts)
        if (auto done = setting.read(part, text); !done) return done;
      return {};
    };
    add_setting(command, setting, settings::standard_text(setting, part), read);
  }
  complete_settings(command);
}

/// Names of the settings that the user gave, by keys too.
settings::Given given_settings(const CLI::App& command);
/// Whether `option` was given a value of its own: more than keys of other settings.
bool gives_itself(const CLI::App& command, const CLI::Option& option);

/// Where `text` is KEY=VALUE or KEY:VALUE with the key of a setting that is given by `option` ("--paper
/// variant="), gives that setting its value, unless it is one of `leave`; false: it is not. Throws
/// CLI::ValidationError.
bool read_key(CLI::App& command, const std::string& option, const std::string& text,
              const settings::Given& leave = {});

/// `texts` of a file for `option`, with the vectors of keys whole that the file's parser took for lists:
/// facing=0,1,0.
std::vector<std::string> with_whole_vectors(const CLI::App& command, const std::string& option,
                                            const std::vector<std::string>& texts);

/// Whether the option is there for an old name alone.
bool is_outdated(const CLI::Option& option);
/// Which name took the place of the old one.
std::string outdated_sentence(const std::string& name);
/// The same for each old name of `command` among `arguments`.
std::vector<std::string> outdated_uses(const CLI::App& command, std::span<const std::string> arguments);
/// Whether the user wants no warnings.
bool is_quiet(const CLI::App& command);

/// " (did you mean --size?)" of the first argument that is no option of `command`; empty: none is near.
std::string did_you_mean(const CLI::App& command);

}  // namespace tenebra::viewer
