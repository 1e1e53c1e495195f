// docs/trade.md: tables, plots and the advice that follows from them. Every figure in it comes from the run
// that writes it.
#include <fmt/core.h>
#include <algorithm>

#include "base/machine.h"
#include "bench/common/bench_page.h"
#include "bench/trade/trade_advice.h"
#include "bench/trade/trade_pair_docs.h"
#include "bench/trade/trade_session.h"
#include "io/output_file.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

std::vector<const TradeTable*> tables_of(const TradeSession& session, const std::string& method) {
  std::vector<const TradeTable*> tables;
  for (const TradeTable& table : session.tables) {
    if (table.method == method) tables.push_back(&table);
  }
  return tables;
}

/// "12.5/**6.4** · 3.1 · 54", times and the first `errors` errors; bold on the front.
std::string cell(const TradePoint& p, std::size_t errors) {
  std::string text;
  for (std::size_t i = 0; i < p.times.size(); ++i)
    text += fmt::format("{0}{1}{2}{1}", i == 0 ? "" : "/", p.times[i].front ? "**" : "",
                        short_number(p.times[i].ms));
  for (std::size_t i = 0; i < errors; ++i) text += " · " + short_number(p.errors[i]);
  return text;
}

/// A row of a table: a setting, or all of a family.
struct SettingRow {
  std::string name;
  bool family = false;
};

bool is_ours(const TradePoint& p) {
  return !p.family.starts_with("Embree") && !p.family.starts_with("shafts") && p.family != "shadow map";
}

/// A family of several settings, none of them on a front or measured on few views alone, is one row; of
/// Embree and shadow maps the settings on no front are left out.
std::vector<SettingRow> setting_rows(const std::vector<const TradeTable*>& tables) {
  struct Setting {
    const TradePoint* point;
    bool front;
  };
  std::vector<Setting> settings;
  for (const TradeTable* table : tables) {
    for (const TradePoint& p : table->points) {
      const bool front =
          std::any_of(p.times.begin(), p.times.end(), [](const TradeTime& time) { return time.front; });
      const auto same = std::find_if(settings.begin(), settings.end(),
                                     [&](const Setting& s) { return s.point->name() == p.name(); });
      if (same == settings.end())
        settings.push_back({&p, front});
      else
        same->front |= front;
    }
  }
  std::vector<SettingRow> rows;
  for (const Setting& s : settings) {
    const auto alike = [&](const Setting& other) { return other.point->family == s.point->family; };
    const bool some_front = std::any_of(settings.begin(), settings.end(),
                                        [&](const Setting& other) { return alike(other) && other.front; });
    const bool several = std::count_if(settings.begin(), settings.end(), alike) > (is_ours(*s.point) ? 2 : 1);
    const bool rare =
        2 * std::count_if(tables.begin(), tables.end(),
                          [&](const TradeTable* table) { return table->find(s.point->name()) != nullptr; }) <
        std::ssize(tables);
    if (several && (!some_front || rare)) {
      const auto listed = [&](const SettingRow& row) { return row.family && row.name == s.point->family; };
      if (std::none_of(rows.begin(), rows.end(), listed)) rows.push_back({s.point->family, true});
    } else if (s.front || is_ours(*s.point) || !some_front) {
      rows.push_back({s.point->name()});
    }
  }
  return rows;
}

/// "12.5 to 31.0", or one number where both are the same.
std::string range_text(std::vector<double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const std::string from = short_number(*least), to = short_number(*most);
  return from == to ? from : from + " to " + to;
}

/// Times on each number of threads and the first `errors` errors of all settings of a family, from the least.
std::string family_cell(const TradeTable& table, const std::string& family, std::size_t errors) {
  std::vector<std::vector<double>> times, wrong(errors);
  for (const TradePoint& p : table.points) {
    if (p.family != family) continue;
    times.resize(p.times.size());
    for (std::size_t i = 0; i < p.times.size(); ++i) times[i].push_back(p.times[i].ms);
    for (std::size_t i = 0; i < errors; ++i) wrong[i].push_back(p.errors[i]);
  }
  std::string text;
  for (const auto& values : times) text += (text.empty() ? "" : "/") + range_text(values);
  for (const auto& values : wrong)
    if (!values.empty()) text += " · " + range_text(values);
  return text;
}

/// Settings down, views across: times and the first `errors` errors.
std::string settings_table(const std::vector<const TradeTable*>& tables, std::size_t errors) {
  std::string text = "| setting |", rule = "|---|";
  for (const TradeTable* table : tables) {
    text += fmt::format(" {} |", table->view);
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const SettingRow& row : setting_rows(tables)) {
    text += fmt::format("| {} |", row.name);
    for (const TradeTable* table : tables) {
      const TradePoint* p = row.family ? nullptr : table->find(row.name);
      const std::string of_view = row.family     ? family_cell(*table, row.name, errors)
                                  : p == nullptr ? ""
                                                 : cell(*p, errors);
      text += of_view.empty() ? " |" : fmt::format(" {} |", of_view);
    }
    text += "\n";
  }
  return text + "\n";
}

/// "31 to 44": the settings of one family that take least and most.
std::string memory_cell(const TradeTable& table, const std::string& family) {
  std::vector<double> mb;
  for (const TradePoint& p : table.points)
    if (p.family == family) mb.push_back(p.mb);
  if (mb.empty()) return "";
  const auto [least, most] = std::minmax_element(mb.begin(), mb.end());
  const std::string from = fmt::format("{:.0f}", *least), to = fmt::format("{:.0f}", *most);
  return from == to ? from : fmt::format("{} to {}", from, to);
}

/// Families down, views across.
std::string memory_table(const std::vector<const TradeTable*>& tables) {
  std::string text = "| MB |", rule = "|---|";
  std::vector<std::string> families;
  for (const TradeTable* table : tables) {
    text += fmt::format(" {} |", table->view);
    rule += "---|";
    for (const TradePoint& p : table->points)
      if (std::find(families.begin(), families.end(), p.family) == families.end())
        families.push_back(p.family);
  }
  text += "\n" + rule + "\n";
  for (const std::string& family : families) {
    text += fmt::format("| {} |", family);
    for (const TradeTable* table : tables) text += fmt::format(" {} |", memory_cell(*table, family));
    text += "\n";
  }
  return text + "\n";
}

constexpr const char* memory_intro =
    "Memory, in 10^6 bytes: the most that is held at one time on one thread, from a fresh start to the "
    "first answer, as the program counts it, with the answer and ";

std::string plots(const std::vector<const TradeTable*>& tables) {
  std::string text;
  for (const TradeTable* table : tables) {
    text += fmt::format("<img src=\"trade_{}.svg\" alt=\"{}, {}\" width=\"49%\"/>\n", plot_name(*table),
                        method_title(table->method), table->view);
  }
  return text + "\n";
}

/// Pictures, each with what it shows below it.
std::string crops(const std::vector<const TradeTable*>& tables) {
  std::string text =
      "What errors of about 0.5, 2 and 8/255 look like, where those of the last of them stand out (the "
      "errors given are the first of the table below). The lower row: 16 times the errors.\n\n";
  for (const TradeTable* table : tables) {
    if (!table->crops) continue;
    text += fmt::format("<img src=\"trade_{}.png\" alt=\"{}, {}\"/>\n\n{}, from the left: {}.\n\n",
                        plot_name(*table), method_title(table->method), table->view, table->view,
                        table->crops->caption);
  }
  return text;
}

std::string remarks(const std::vector<const TradeTable*>& tables) {
  std::string text;
  for (const TradeTable* table : tables) {
    if (!table->remark.empty()) text += fmt::format("- {}: {}\n", table->view, table->remark);
  }
  return text.empty() ? text : text + "\n";
}

/// What measured a section, where: sections may come from different runs.
std::string measured_by(const TradeSession& session, const char* part) {
  const int threads = session.options.threads;
  return fmt::format("Measured by `tenebra-bench trade --only {}{}{}` on an {}.\n\n", part,
                     session.by_effort(" --tiny", " --quick", ""),
                     threads == 0 ? "" : fmt::format(" --threads {}", threads), base::machine_description());
}

std::string head() {
  return "# What accuracy costs\n\n"
         "Written by `tenebra-bench trade --docs docs`; edit `bench/trade/trade_docs.cpp` and "
         "`trade_advice.cpp`, not this file. `--only` writes single sections anew. Times in milliseconds "
         "per frame, \"12.5/6.4\": of one thread (processor time), and of all threads of the machine "
         "(by the clock). Settings take turns, and each time is a median; with `--quick` of 3 runs, or of "
         "fewer where these took 0.25 s together, else of 15, or fewer where they took 4 s.\n\n"
         "A setting is on the **Pareto front** of a view, its time bold, if on so many threads no other "
         "is both as fast and as exact and better in one of the two. Plots and the sentences beside them "
         "are of one thread; in the plots the front is dashed and its settings are ringed. Embree's rays "
         "are given for comparison; they are not a setting of Tenebra. Of them and of shadow maps only "
         "settings on a front are listed; a family none of whose settings is on a front, or that was "
         "measured on "
         "few views, stands in one row, from its least to its most. RMS: root of the mean square. "
         "Penumbra, shaft and other words: [vocabulary](architecture.md#vocabulary).\n\n";
}

std::string hard_section(const TradeSession& session, const std::vector<const TradeTable*>& tables) {
  return "## Hard shadows\n\n" + measured_by(session, "hard") + plots(tables) + hard_advice(tables) +
         "\nTime (visible points included) · wrong pixels:\n\n" + settings_table(tables, 1) + memory_intro +
         "the visible points; of shadow maps without what the rasteriser takes beside them, of Embree "
         "without its points in floats.\n\n" +
         memory_table(tables) +
         "Pictures of 1024x1024, the first light, or the first directional one (sun). Wrong: different "
         "from the exact answer, which `PreciseSorted` gave without vector instructions. Shadow maps are "
         "cubes, of a sun one map over the whole scene, drawn by Tenebra's own rasteriser, on this "
         "machine on the CPU and with ids and normals beside the depth; the bias (constant and "
         "slope-scaled, in widths of a texel) is the best of many for this view, chosen with the exact "
         "mask, which a user does not have. Tenebra offers no tracing at half resolution.\n\n";
}

std::string soft_section(const TradeSession& session, const std::vector<const TradeTable*>& tables) {
  return "## Soft shadows\n\n" + measured_by(session, "soft") + plots(tables) + soft_advice(tables) + "\n" +
         crops(tables) + "Time · RMS error over the penumbra · its worst pixel, in 1/255 of white:\n\n" +
         settings_table(tables, 2) + memory_intro +
         "without the visible points; of Embree with its tree and the starts of its rays.\n\n" +
         memory_table(tables) +
         "Pictures of 1280x720, with `--quick` 960x540; a light of 4 % of the scene's diagonal, the court "
         "its own, and a sun 0.53 degrees wide. Errors against the solver in double precision; up to "
         "0.01/255 they count as none. White is the light that one pixel in a thousand exceeds; errors of "
         "the visible part of the light (`--mask FILE.pfm`) are larger where the light is weak. `clip` "
         "and `bsp`: `--paper soft-solver`. Embree's rays are stratified and drawn beforehand; the time of "
         "its "
         "tree is not counted.\n\n" +
         remarks(tables);
}

std::string ao_section(const TradeSession& session, const std::vector<const TradeTable*>& tables) {
  return "## Ambient occlusion\n\n" + measured_by(session, "ao") + plots(tables) + ao_advice(tables) + "\n" +
         crops(tables) +
         "Time of a frame whose fields and samples exist · RMS error · worst pixel, in 1/255:\n\n" +
         settings_table(tables, 2) + memory_intro +
         "the fields and samples, which are made on all threads; without the visible points; of Embree "
         "with its tree and the points as it reads them.\n\n" +
         memory_table(tables) +
         "Tables are positions x directions. Errors against many rays (1,024 or more) at one pixel of 64. "
         "Embree's rays are the opponent of `tenebra-bench ao` (measuring.md): a lattice shifted from "
         "pixel to pixel in packets, with the time to update the tree, filtered by whichever of one to "
         "three passes errs least.\n\n" +
         remarks(tables);
}

std::string page_of(const TradeSession& session) {
  const std::string before = read_page(session.trade.docs / "trade.md");
  const auto hard = tables_of(session, "hard"), soft = tables_of(session, "soft"),
             ao = tables_of(session, "ao");
  std::string page = head() + preset_section();
  page += hard.empty() ? section_of(before, "Hard shadows") : hard_section(session, hard);
  page += soft.empty() ? section_of(before, "Soft shadows") : soft_section(session, soft);
  page += ao.empty() ? section_of(before, "Ambient occlusion") : ao_section(session, ao);
  page += session.stages.empty() ? section_of(before, stages_title)
                                 : stages_section(measured_by(session, "stages"), session.stages);
  page += session.needs.empty() ? section_of(before, needs_title)
                                : needs_section(measured_by(session, "needs"), session.needs);
  return page;
}

}  // namespace

Expected<void> write_trade_page(const TradeSession& session) {
  const std::string page = page_of(session);
  const std::filesystem::path& docs = session.trade.docs;
  for (const TradeTable& table : session.tables) {
    const std::string stem = "trade_" + plot_name(table);
    if (auto written = io::write_file(docs / (stem + ".svg"), trade_plot(table)); !written) return written;
    if (!table.crops) continue;
    if (auto written = io::write_png(docs / (stem + ".png"), table.crops->image); !written) return written;
  }
  return io::write_file(docs / "trade.md", page);
}

}  // namespace tenebra::bench
