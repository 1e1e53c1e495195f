#include "options/help_pages.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>

#include "options/command_settings.h"
#include "options/settings_names.h"

namespace tenebra::viewer {
namespace {

using settings::About;
using settings::Group;

constexpr std::size_t column = 34;
/// With fewer groups all help of a command is one page.
constexpr std::size_t fewest_topics = 4;

struct Topic {
  std::string_view word;
  Group group;
};
constexpr std::array topics{Topic{"scene", Group::scene},     Topic{"camera", Group::camera},
                            Topic{"picture", Group::picture}, Topic{"shadows", Group::shadows},
                            Topic{"ao", Group::ao},           Topic{"output", Group::output},
                            Topic{"run", Group::run}};
constexpr std::string_view paper = "paper", everything = "all";

/// What people ask for first.
constexpr std::array<std::string_view, 10> first_asked{"output",     "size",       "frames",  "shadows",
                                                       "light-size", "ao",         "quality", "exposure",
                                                       "camera",     "environment"};

bool has_page(std::string_view group) {
  return std::ranges::any_of(topics,
                             [&](const Topic& topic) { return settings::group_title(topic.group) == group; });
}

enum class Page { first, group, everything };

/// Lists all options, those of one group, or those whose group has no page of its own.
class HelpFormat : public CLI::Formatter {
public:
  explicit HelpFormat(Page page = Page::everything, std::string_view group = "")
      : page_(page), group_(group) {
    column_width(column);
  }

  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    if (!is_positional &&
        ((page_ == Page::first && has_page(group)) || (page_ == Page::group && group != group_)))
      return "";
    if (group == settings::group_title(Group::first))
      std::stable_sort(options.begin(), options.end(),
                       [](const CLI::Option* a, const CLI::Option* b) { return place(*a) < place(*b); });
    return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
  }

private:
  static std::ptrdiff_t place(const CLI::Option& option) {
    return std::find(first_asked.begin(), first_asked.end(), setting_of(option)) - first_asked.begin();
  }

  Page page_;
  std::string group_;
};

/// Topics whose groups `command` has.
std::vector<std::string_view> topics_of(const CLI::App& command) {
  std::vector<std::string_view> found;
  for (const Topic& topic : topics)
    if (std::ranges::any_of(command.get_options(), [&](const CLI::Option* option) {
          return option->get_group() == settings::group_title(topic.group);
        }))
      found.push_back(topic.word);
  return found;
}

/// Names and helps in two columns.
std::string help_of_paper(CLI::App& command) {
  std::string text = fmt::format(
      "Settings for the papers' experiments: tenebra {} --paper KEY=VALUE, which may be repeated. The\n"
      "defaults are the better methods; pictures are the same with most of these.\n\n",
      command.get_name());
  for (const About* about : settings_by(command, paper_option)) {
    const CLI::Option* option = option_for(command, *about);
    const std::string name = fmt::format("  {}={}", about->name, option->get_type_name());
    std::string help = option->get_description();
    for (std::size_t at = 0; (at = help.find('\n', at)) != std::string::npos; at += column + 1)
      help.insert(at + 1, column, ' ');
    text += name.size() < column ? fmt::format("{:<{}}{}\n", name, column, help)
                                 : fmt::format("{}\n{:{}}{}\n", name, "", column, help);
  }
  return text;
}

/// The examples up to the first empty line, and what other pages there are.
std::string first_footer(const CLI::App& command, const std::vector<std::string_view>& others) {
  const std::string examples = command.get_footer();
  return fmt::format("{}\n\nMore options: tenebra {} --help TOPIC, one of {}, {} or {}",
                     examples.substr(0, examples.find("\n\n")), command.get_name(), fmt::join(others, ", "),
                     paper, everything);
}

std::string topic_or_none(const std::string& word) {
  const bool is_known = word == paper || word == everything ||
                        std::ranges::any_of(topics, [&](const Topic& topic) { return topic.word == word; });
  return is_known ? word : std::string();
}

}  // namespace

std::shared_ptr<CLI::Formatter> help_format() {
  return std::make_shared<HelpFormat>();
}

std::string help_topic(std::span<const std::string> arguments) {
  const auto help = std::ranges::find_if(
      arguments, [](const std::string& argument) { return argument == "--help" || argument == "-h"; });
  if (help == arguments.end()) return "";
  if (help + 1 != arguments.end()) return topic_or_none(*(help + 1));
  return arguments.size() == 3 ? topic_or_none(arguments[1]) : "";
}

std::string help_page(CLI::App& program, const std::string& topic) {
  if (program.get_subcommands().empty()) return program.help();
  CLI::App& command = *program.get_subcommands().back();
  const std::vector<std::string_view> others = topics_of(command);
  if (topic == paper && !settings_by(command, paper_option).empty()) return help_of_paper(command);
  if (others.size() < fewest_topics) return program.help();
  if (topic == everything) return program.help() + "\n" + help_of_paper(command);
  const auto chosen = std::ranges::find_if(topics, [&](const Topic& other) { return other.word == topic; });
  const bool is_first = chosen == topics.end();
  command.formatter(is_first
                        ? std::make_shared<HelpFormat>(Page::first)
                        : std::make_shared<HelpFormat>(Page::group, settings::group_title(chosen->group)));
  command.footer(is_first ? first_footer(command, others) : "");
  std::string page = program.help();
  for (std::size_t at; (at = page.find("\n\n\n")) != std::string::npos;)
    page.erase(at, 1);  // left by other groups
  return page;
}

}  // namespace tenebra::viewer
