#include "options/options_page.h"

#include <fmt/core.h>

#include <vector>

#include "options/output_table.h"
#include "settings/tables.h"

namespace tenebra::viewer {
namespace {

using settings::About;
using settings::Affects;
using settings::Audience;
using settings::Group;

constexpr const char* heading =
    "# All options\n"
    "\n"
    "Written by `tenebra --options-page` from the tables that the program reads its options by; do not edit. "
    "[commands.md](commands.md)\n"
    "has the background. The options are those of `tenebra render`; the other commands share the ones that "
    "concern "
    "them, and\n"
    "`tenebra COMMAND --help` has the rest. In a file of options (`--config`) the names stand without "
    "dashes, in Python "
    "with\n"
    "`_` for `-`; there, keys of other options are keywords of their own: `sun_size=1`, "
    "`light_facing=(0, 1, 0)`, `soft_memory=300`, `variant=\"Spheres\"`.\n"
    "What changes nothing but time or files leaves every bit of every picture as it is.\n";

struct PageRow {
  const About* about;
  std::string standard;
};

template <class Part>
void add_rows(std::span<const settings::Setting<Part>> table, std::vector<PageRow>& rows) {
  for (const settings::Setting<Part>& setting : table)
    rows.push_back({&setting, settings::standard_text(setting)});
}

/// Text within a cell of a table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string changed(Affects affects) {
  switch (affects) {
    case Affects::picture:
      return "";
    case Affects::speed:
      return " (time alone)";
    case Affects::files:
      return " (files alone)";
  }
  return "";
}

std::string line(const PageRow& row) {
  const About& about = *row.about;
  const std::string name = fmt::format("{}{}", settings::given_as(about), settings::value_name(about));
  const std::string letter = about.letter.empty() ? "" : fmt::format("`-{}`, ", about.letter);
  return fmt::format("| {}`{}` | {} | {}{} |\n", letter,
                     cell(about.is_switch ? settings::option_name(about) : name), cell(row.standard),
                     cell(about.help), changed(about.affects));
}

std::string table_head() {
  return "\n| option | default | what it does |\n|---|---|---|\n";
}

/// Whether it is a key of another option, whose row describes it.
bool is_key(const About& about) {
  return !about.as.empty();
}

}  // namespace

std::string options_page() {
  std::vector<PageRow> rows;
  add_rows(output_table(), rows);
  add_rows(settings::scene_table(), rows);
  add_rows(settings::method_table(), rows);
  std::string text = heading;
  for (const Group group : {Group::first, Group::scene, Group::camera, Group::picture, Group::shadows,
                            Group::ao, Group::output, Group::run}) {
    text += fmt::format("\n## {}\n{}", settings::group_title(group), table_head());
    for (const PageRow& row : rows)
      if (row.about->group == group && row.about->audience != Audience::paper && !is_key(*row.about))
        text += line(row);
  }
  text +=
      "\n## For the papers' experiments\n\n`--paper` may be repeated; `tenebra render --help paper` lists "
      "these.\n" +
      table_head();
  for (const PageRow& row : rows)
    if (row.about->audience == Audience::paper) text += line(row);
  return text;
}

}  // namespace tenebra::viewer
