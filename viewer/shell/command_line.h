// Commands and their options. They hide CLI11, whose header takes longer to compile than any file that adds
// options: only command_line.cpp, config_file.cpp, memory_option.cpp and main.cpp include it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/expected.h>

namespace CLI {
class App;
class Option;
class ParseError;
}  // namespace CLI

namespace tenebra::viewer {

/// An option of a command. Each call returns the option, so that calls can be chained.
class AddedOption {
public:
  explicit AddedOption(CLI::Option& option) : option_(&option) {}

  AddedOption type_name(const std::string& name) const;  ///< what the help writes for the value
  AddedOption group(const std::string& name) const;      ///< the heading of the help that it stands under
  AddedOption needs(AddedOption other) const;
  AddedOption excludes(AddedOption other) const;
  AddedOption required() const;

private:
  CLI::Option* option_;
};

/// Adds a command to `program`.
CLI::App& add_command(CLI::App& program, const std::string& name, const std::string& help);
/// What follows the options in the command's help.
void set_examples(CLI::App& command, const std::string& examples);
/// Calls `chosen` once the options of `command` are read, if the user chose it.
void when_chosen(CLI::App& command, std::function<void()> chosen);

// Options and positional arguments. What they are read into must live as long as `command`.
AddedOption add_flag(CLI::App& command, const std::string& name, bool& target, const std::string& help);
AddedOption add_text(CLI::App& command, const std::string& name, std::string& target,
                     const std::string& help);
AddedOption add_text(CLI::App& command, const std::string& name, std::optional<std::string>& target,
                     const std::string& help);
/// May be repeated.
AddedOption add_texts(CLI::App& command, const std::string& name, std::vector<std::string>& target,
                      const std::string& help);
/// A positional argument of one or more values.
AddedOption add_files(CLI::App& command, const std::string& name, std::vector<std::string>& target,
                      const std::string& help);
/// May be repeated; `read` gets all values at once, its failure becomes "NAME: sentence".
AddedOption add_texts(CLI::App& command, const std::string& name,
                      std::function<Expected<void>(const std::vector<std::string>&)> read,
                      const std::string& help);
/// `read` gets the value, its failure becomes "NAME: sentence". Given twice, the last counts.
AddedOption add_reader(CLI::App& command, const std::string& name,
                       std::function<Expected<void>(const std::string&)> read, const std::string& help);

/// A flag: `read` gets whether it is on.
AddedOption add_switch(CLI::App& command, const std::string& name, std::function<Expected<void>(bool)> read,
                       const std::string& help);

/// Adds an option with a function that makes the value of `target` from text.
template <class Target, class Value>
AddedOption add_value(CLI::App& command, const std::string& name, Target& target,
                      Expected<Value> (*parse)(const std::string&), const std::string& help) {
  const auto read = [&target, parse](const std::string& text) -> Expected<void> {
    auto value = parse(text);
    if (!value) return tl::unexpected(std::move(value.error()));
    target = std::move(*value);
    return {};
  };
  return add_reader(command, name, read, help);
}

/// The option of that name, which the command must have.
AddedOption option_of(CLI::App& command, const std::string& name);
/// Whether the option, which the command must have, was given.
bool was_given(const CLI::App& command, const std::string& name);

/// A command that stands alone, without --help, for options within the text of another option.
std::shared_ptr<CLI::App> lone_command();
/// Reads the arguments in `text`; a failure is the sentence of what was refused.
Expected<void> parse_arguments(CLI::App& command, const std::string& text);

/// CLI11's "--size: 1 required WxH missing" in the words of all other refusals, the rest as it stands.
std::string sentence_of(const CLI::ParseError& error);

}  // namespace tenebra::viewer
