#include "shell/command_line.h"

#include <CLI/CLI.hpp>
#include <string_view>

#include "base/fail.h"

namespace tenebra::viewer {
namespace {

/// "found , expected ..." of an empty text as "found nothing, expected ...".
std::string without_gap(std::string sentence) {
  constexpr std::string_view gap = "found , ";
  return sentence.starts_with(gap) ? sentence.replace(0, gap.size(), "found nothing, ") : sentence;
}

}  // namespace

AddedOption AddedOption::type_name(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

AddedOption AddedOption::group(const std::string& name) const {
  option_->group(name);
  return *this;
}

AddedOption AddedOption::needs(AddedOption other) const {
  option_->needs(other.option_);
  return *this;
}

AddedOption AddedOption::excludes(AddedOption other) const {
  option_->excludes(other.option_);
  return *this;
}

AddedOption AddedOption::required() const {
  option_->required();
  return *this;
}

CLI::App& add_command(CLI::App& program, const std::string& name, const std::string& help) {
  return *program.add_subcommand(name, help);
}

void set_examples(CLI::App& command, const std::string& examples) {
  command.footer(examples);
}

void when_chosen(CLI::App& command, std::function<void()> chosen) {
  command.callback(std::move(chosen));
}

AddedOption add_flag(CLI::App& command, const std::string& name, bool& target, const std::string& help) {
  return AddedOption(*command.add_flag(name, target, help));
}

AddedOption add_text(CLI::App& command, const std::string& name, std::string& target,
                     const std::string& help) {
  return AddedOption(*command.add_option(name, target, help));
}

AddedOption add_text(CLI::App& command, const std::string& name, std::optional<std::string>& target,
                     const std::string& help) {
  return AddedOption(*command.add_option(name, target, help));
}

AddedOption add_texts(CLI::App& command, const std::string& name, std::vector<std::string>& target,
                      const std::string& help) {
  return AddedOption(*command.add_option(name, target, help)->allow_extra_args(false));
}

AddedOption add_files(CLI::App& command, const std::string& name, std::vector<std::string>& target,
                      const std::string& help) {
  return AddedOption(*command.add_option(name, target, help));
}

AddedOption add_texts(CLI::App& command, const std::string& name,
                      std::function<Expected<void>(const std::vector<std::string>&)> read,
                      const std::string& help) {
  const auto read_all = [read = std::move(read), name](const std::vector<std::string>& texts) {
    if (auto done = read(texts); !done) throw CLI::ValidationError(name, without_gap(done.error().message));
  };
  return AddedOption(
      *command.add_option_function<std::vector<std::string>>(name, read_all, help)->allow_extra_args(false));
}

AddedOption add_reader(CLI::App& command, const std::string& name,
                       std::function<Expected<void>(const std::string&)> read, const std::string& help) {
  const auto read_one = [read = std::move(read), name](const std::string& text) {
    if (auto done = read(text); !done) throw CLI::ValidationError(name, without_gap(done.error().message));
  };
  return AddedOption(*command.add_option_function<std::string>(name, read_one, help)->take_last());
}

AddedOption add_switch(CLI::App& command, const std::string& name, std::function<Expected<void>(bool)> read,
                       const std::string& help) {
  const auto read_count = [read = std::move(read), name](std::int64_t count) {
    if (auto done = read(count > 0); !done) throw CLI::ValidationError(name, done.error().message);
  };
  return AddedOption(*command.add_flag_function(name, read_count, help));
}

AddedOption option_of(CLI::App& command, const std::string& name) {
  return AddedOption(*command.get_option(name));
}

bool was_given(const CLI::App& command, const std::string& name) {
  return command.get_option(name)->count() > 0;
}

std::shared_ptr<CLI::App> lone_command() {
  auto command = std::make_shared<CLI::App>();
  command->set_help_flag();
  return command;
}

Expected<void> parse_arguments(CLI::App& command, const std::string& text) {
  try {
    command.parse(text);
    return {};
  } catch (const CLI::ParseError& error) {
    return base::fail("{}", sentence_of(error));
  }
}

std::string sentence_of(const CLI::ParseError& error) {
  std::string text = error.what();
  constexpr std::string_view required = ": 1 required ", missing = " missing";
  const std::size_t at = text.find(required);
  if (at == std::string::npos || !text.ends_with(missing)) return text;
  text.resize(text.size() - missing.size());
  return text.replace(at, required.size(), ": found no value, expected ");
}

}  // namespace tenebra::viewer
