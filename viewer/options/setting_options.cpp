#include "options/setting_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

#include "base/fail.h"
#include "options/command_settings.h"
#include "options/output_table.h"
#include "options/settings_names.h"

namespace tenebra::viewer {
namespace {

using settings::About;
using settings::Group;

constexpr const char* hidden = "";
constexpr std::size_t help_width = 59;

std::string title(Group group) {
  return std::string(settings::group_title(group));
}

std::string help_text(const About& about, const std::string& standard) {
  return standard.empty() ? std::string(about.help) : fmt::format("{} [{}]", about.help, standard);
}

/// What `text`, given to `option`, is the value of by a key; none: it has no key.
struct KeyedText {
  const About* about = nullptr;
  std::string value;
};
std::optional<KeyedText> keyed(const CLI::App& command, const std::string& option, const std::string& text) {
  for (const About* about : settings_by(command, option)) {
    const std::string key = settings::given_as(*about).substr(option.size() + 1);
    if (!key.empty() && settings::is_word(text.substr(0, key.size()), key))
      return KeyedText{about, text.substr(key.size())};
  }
  return std::nullopt;
}

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw CLI::ValidationError(name, what);
}

std::string known_keys(CLI::App& command, const std::string& text) {
  std::vector<std::string> known;
  for (const About* about : settings_by(command, paper_option)) known.emplace_back(about->name);
  return fmt::format("{}{}", fmt::join(known, ", "),
                     settings::did_you_mean(text.substr(0, text.find('=')), known));
}

void add_paper(CLI::App& command) {
  if (command.get_option_no_throw(paper_option) != nullptr || settings_by(command, paper_option).empty())
    return;
  const auto read = [&command](const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      if (!read_key(command, paper_option, text))
        refuse(paper_option,
               fmt::format("found {}, expected KEY=VALUE with one of {}", text, known_keys(command, text)));
  };
  command
      .add_option_function<std::vector<std::string>>(
          paper_option, read,
          "A setting for the papers' experiments, listed by\n--help paper; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE")
      ->group(title(Group::run));
}

void link_needs(CLI::App& command) {
  for (CLI::Option* option : command.get_options(nullptr)) {
    const About* about = about_of(setting_of(*option));
    if (about == nullptr) continue;
    if (CLI::Option* other = command.get_option_no_throw(long_name(about->needs))) option->needs(other);
    if (CLI::Option* other = command.get_option_no_throw(long_name(about->excludes))) option->excludes(other);
  }
}

}  // namespace

std::string wrapped(std::string_view text) {
  std::string lines;
  std::size_t in_line = 0;
  for (const std::string_view word : settings::split(text, ' ')) {
    const bool fits = in_line == 0 || in_line + 1 + word.size() <= help_width;
    if (!lines.empty()) lines += fits ? " " : "\n";
    in_line = fits && in_line > 0 ? in_line + 1 + word.size() : word.size();
    lines += word;
  }
  return lines;
}

AddedOption add_setting(CLI::App& command, const About& about, const std::string& standard, ReadTexts read) {
  const std::string longer = long_name(about.name), help = wrapped(help_text(about, standard));
  const std::string name = about.letter.empty() ? longer : fmt::format("-{},{}", about.letter, longer);
  const auto read_all = [&command, longer, read](const std::vector<std::string>& texts) -> Expected<void> {
    std::vector<std::string> own;
    for (const std::string& text : texts)
      if (!read_key(command, longer, text)) own.push_back(text);
    return own.empty() ? Expected<void>() : read(own);
  };
  AddedOption option = [&] {
    if (about.is_switch)
      return add_switch(
          command, name, [read](bool on) { return read({on ? "true" : "false"}); }, help);
    if (about.several || about.has_keys) return add_texts(command, name, read_all, help);
    return add_reader(
        command, name, [read](const std::string& text) { return read({text}); }, help);
  }();
  if (!about.is_switch) option.type_name(settings::value_name(about));
  if (CLI::Option* of_help = command.get_help_ptr()) of_help->group(title(Group::first));
  return option.group(settings::given_as(about) == longer + " " ? title(about.group) : hidden);
}

void complete_settings(CLI::App& command) {
  add_paper(command);
  link_needs(command);
}

settings::Given given_settings(const CLI::App& command) {
  settings::Given given;
  for (const CLI::Option* option : command.get_options())
    if (gives_itself(command, *option)) given.insert(setting_of(*option));
  return given;
}

bool gives_itself(const CLI::App& command, const CLI::Option& option) {
  const auto& texts = option.results();
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return !keyed(command, option.get_name(), text); });
}

bool read_key(CLI::App& command, const std::string& option, const std::string& text,
              const settings::Given& leave) {
  const auto key = keyed(command, option, text);
  if (!key) return false;
  if (leave.contains(key->about->name)) return true;
  CLI::Option& target = *option_for(command, *key->about);
  try {
    if (!target.empty() && !target.get_callback_run()) target.run_callback();  // what its old name was given
    target.clear();
    target.add_result(key->value);
    target.run_callback();
  } catch (const CLI::ValidationError& error) {
    const std::string said = error.what(), before = long_name(key->about->name) + ": ";
    refuse(settings::option_name(*key->about), said.starts_with(before) ? said.substr(before.size()) : said);
  }
  return true;
}

std::vector<std::string> with_whole_vectors(const CLI::App& command, const std::string& option,
                                            const std::vector<std::string>& texts) {
  std::vector<std::string> whole;
  std::ptrdiff_t missing = 0;  // numbers of the last one
  for (const std::string& text : texts) {
    if (missing > 0) {
      whole.back() += "," + text, --missing;
      continue;
    }
    whole.push_back(text);
    if (const auto key = keyed(command, option, text))
      missing = std::ranges::count(key->about->value, ',') - std::ranges::count(key->value, ',');
  }
  return whole;
}

bool is_outdated(const CLI::Option& option) {
  const About* about = about_of(setting_of(option));
  return option.get_group() == hidden && about != nullptr &&
         settings::given_as(*about) != long_name(about->name) + " ";
}

std::string outdated_sentence(const std::string& name) {
  return fmt::format("--{} is {}VALUE now; the old name goes with the next version", name,
                     settings::given_as(*about_of(name)));
}

std::vector<std::string> outdated_uses(const CLI::App& command, std::span<const std::string> arguments) {
  std::vector<std::string> sentences;
  for (const std::string_view argument : arguments) {
    if (!argument.starts_with("--")) continue;
    const std::string name(argument.substr(0, argument.find('=')));
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option != nullptr && is_outdated(*option)) sentences.push_back(outdated_sentence(name.substr(2)));
  }
  return sentences;
}

bool is_quiet(const CLI::App& command) {
  const CLI::Option* option = command.get_option_no_throw("--quiet");
  return option != nullptr && !option->empty();
}

std::string did_you_mean(const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    if (!is_outdated(*option))
      for (const std::string& name : option->get_lnames()) known.push_back(name);
  for (const std::string& argument : command.remaining()) {
    if (!argument.starts_with("--")) continue;
    return settings::did_you_mean(argument.substr(2, argument.find('=') - 2), known, "--{}");
  }
  return "";
}

}  // namespace tenebra::viewer
