// docs/trade.md: tables, plots and the advice that follows from them. Every figure in it comes from the run
// that writes it.
#include <fmt/core.h>
#include <algorithm>
#include <map>

#include "base/machine.h"
#include "base/output_file.h"
#include "bench/common/bench_page.h"
#include "bench/trade/trade_advice.h"
#include "bench/trade/trade_session.h"
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

/// "12.5 · 3.1 · 54", time and errors `first` to `last`; the time bold on the front.
std::string cell(const TradePoint& p, std::size_t first, std::size_t last, bool with_time) {
  std::string text;
  if (with_time) text = p.front ? fmt::format("**{}**", short_number(p.ms)) : short_number(p.ms);
  for (std::size_t i = first; i < last; ++i) text += (text.empty() ? "" : " · ") + short_number(p.errors[i]);
  return text;
}

/// Settings down, views across.
std::string settings_table(const std::vector<const TradeTable*>& tables, std::size_t first, std::size_t last,
                           bool with_time) {
  std::string text = "| setting |", rule = "|---|";
  std::vector<std::string> names;
  for (const TradeTable* table : tables) {
    text += fmt::format(" {} |", table->view);
    rule += "---|";
    for (const TradePoint& p : table->points) {
      if (std::find(names.begin(), names.end(), p.name()) == names.end()) names.push_back(p.name());
    }
  }
  text += "\n" + rule + "\n";
  for (const std::string& name : names) {
    text += fmt::format("| {} |", name);
    for (const TradeTable* table : tables) {
      const TradePoint* p = table->find(name);
      text += p == nullptr ? " |" : fmt::format(" {} |", cell(*p, first, last, with_time));
    }
    text += "\n";
  }
  return text + "\n";
}

std::string plots(const std::vector<const TradeTable*>& tables) {
  std::string text;
  for (const TradeTable* table : tables) {
    text += fmt::format("<img src=\"trade_{}.svg\" alt=\"{}, {}\" width=\"49%\"/>\n", plot_name(*table),
                        method_title(table->method), table->view);
  }
  return text + "\n";
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
  return fmt::format("Measured by `tenebra-bench trade --only {}{}{}` on an {}: {}.\n\n", part,
                     session.by_effort(" --tiny", " --quick", ""),
                     threads == 0 ? "" : fmt::format(" --threads {}", threads), base::machine_description(),
                     thread_count() == 1 ? "1 thread, processor time"
                                         : fmt::format("{} threads, by the clock", thread_count()));
}

std::string head() {
  return "# What accuracy costs\n\n"
         "Written by `tenebra-bench trade --docs docs`; edit `tests/bench/trade/trade_docs.cpp` and "
         "`trade_advice.cpp`, not this file. `--only` writes single sections anew. Times in milliseconds per "
         "frame.\n\n"
         "A setting is on the **Pareto front** of a view, its time bold, if no other is both as fast and as "
         "exact and better in one of the two. In the plots the front is dashed and its settings are ringed. "
         "Embree's rays are given for comparison; they are not a setting of Tenebra. RMS: root of the mean "
         "square. Penumbra, shaft and other words: [vocabulary](architecture.md#vocabulary).\n\n";
}

std::string hard_section(const TradeSession& session, const std::vector<const TradeTable*>& tables) {
  return "## Hard shadows\n\n" + measured_by(session, "hard") + plots(tables) + hard_advice(tables) +
         "\nTime (visible points included) · wrong pixels:\n\n" + settings_table(tables, 0, 1, true) +
         "Pictures of 1024x1024, the first light. Wrong: different from the exact answer, which "
         "`PreciseSorted` gave without vector instructions. Shadow maps are cubes drawn by Tenebra's own "
         "rasteriser, on this machine on the CPU and with ids and normals beside the depth; the bias "
         "(constant and slope-scaled, in widths of a texel) is the best of many for this view, chosen with "
         "the exact mask, which a user does not have. Tenebra offers no tracing at half resolution.\n"
         "\n" +
         remarks(tables);
}

std::string soft_section(const TradeSession& session, const std::vector<const TradeTable*>& tables) {
  return "## Soft shadows\n\n" + measured_by(session, "soft") + plots(tables) + soft_advice(tables) +
         "\nTime · RMS error over the penumbra · its worst pixel, in 1/255 of white:\n\n" +
         settings_table(tables, 0, 2, true) + "The same over the whole picture: RMS · worst pixel:\n\n" +
         settings_table(tables, 2, 4, false) +
         "Pictures of 1280x720; a light of 4 % of the scene's diagonal, the court its own. Errors against "
         "the solver in double precision; up to 0.01/255 they count as none. White is the light that one "
         "pixel in a thousand exceeds; errors of the visible part of the light (`--mask FILE.pfm`) are "
         "larger where the light is weak. `clip`: `--soft-solver`; `bsp` takes part in runs without "
         "`--quick`. Embree's rays are stratified and drawn beforehand; its tree is not counted.\n"
         "\n" +
         remarks(tables);
}

std::string ao_section(const TradeSession& session, const std::vector<const TradeTable*>& tables) {
  return "## Ambient occlusion\n\n" + measured_by(session, "ao") + plots(tables) + ao_advice(tables) +
         "\nTime of a frame whose fields and samples exist · RMS error · worst pixel, in 1/255:\n\n" +
         settings_table(tables, 0, 2, true) +
         "Tables are positions x directions. Errors against many rays (1,024 or more) at one pixel of 64. "
         "Embree's rays are the opponent of `tenebra-bench ao` (measuring.md): a lattice shifted from pixel "
         "to pixel in packets, with the time to update the tree, filtered by whichever of one to three "
         "passes errs least.\n"
         "\n" +
         remarks(tables);
}

constexpr const char* stages_title = "Stages switched off alone";

/// How long the frame takes without each stage, over all views.
std::string stages_summary(const std::vector<StageRow>& stages) {
  std::map<std::string, std::vector<double>> ratios;
  std::vector<std::string> order;
  for (const StageRow& s : stages) {
    if (!ratios.contains(s.stage)) order.push_back(s.stage);
    ratios[s.stage].push_back(s.without_ms / s.ms);
  }
  std::string text =
      "| stage | time without it over time with it | saves a twentieth or more on |\n|---|---|---|\n";
  for (const std::string& stage : order) {
    const std::vector<double>& of = ratios[stage];
    const auto [least, most] = std::minmax_element(of.begin(), of.end());
    text += fmt::format("| {} | {:.2f} to {:.2f} | {} of {} views |\n", stage, *least, *most,
                        std::count_if(of.begin(), of.end(), [](double ratio) { return ratio >= 1.05; }),
                        of.size());
  }
  return text + "\n";
}

/// Time and memory as it is and without; bold where the stage makes the frame a twentieth quicker or slower.
std::string stages_section(const TradeSession& session, const std::vector<StageRow>& stages) {
  std::string text =
      fmt::format("## {}\n\n{}", stages_title, measured_by(session, "stages")) +
      "With `--quick` 256x256 pixels and medians of 3, else 1024x1024 and of 5. Whole frames by the "
      "program's "
      "renderer, hard shadows unless the row says otherwise: as it draws them, and with this stage alone "
      "switched off or done in full. MB: what the renderer and its frames take. Same bits: of the picture, "
      "where that is promised. knot: a mesh that stands still, without a light or texture of its own.\n\n" +
      stages_summary(stages) +
      "Early accept and the second pass run only in the paper's variants that are named after them. Bold: "
      "more than 5 % slower or quicker without.\n\n"
      "| stage | view | ms | without | MB | without | same bits |\n|---|---|---|---|---|---|---|\n";
  for (const StageRow& s : stages) {
    const bool matters = s.without_ms > 1.05 * s.ms || s.without_ms < 0.95 * s.ms;
    text +=
        fmt::format("| {} | {} | {} | {}{}{} | {:.0f} | {:.0f} | {} |\n", s.stage, s.view, short_number(s.ms),
                    matters ? "**" : "", short_number(s.without_ms), matters ? "**" : "", s.mb, s.without_mb,
                    s.same ? *s.same ? "yes" : "NOT the same bits" : "not promised");
  }
  return text + "\n";
}

std::string needs_section(const TradeSession& session, const std::vector<NeedRow>& needs) {
  std::string text =
      "## Only what a scene requires\n\n" + measured_by(session, "needs") +
      "The cost of stages that do only what the frame needs, and what they would cost if they did all of it. "
      "Where both were run, both gave the same bits, or the row says that they did not; rows without times "
      "only count. (Behind shafts only the dark points are compared: at the others rays are as noisy as "
      "without.) Tests check the same: `tests/render/needs_test.cpp`.\n"
      "\n"
      "| stage | view | ms | all, ms | what is left |\n"
      "|---|---|---|---|---|\n";
  for (const NeedRow& n : needs) {
    const bool timed = n.all_ms > 0;
    text += fmt::format("| {} | {} | {} | {} | {}{} |\n", n.stage, n.view,
                        timed ? short_number(n.with_ms) : "", timed ? short_number(n.all_ms) : "", n.shrunk,
                        n.same.value_or(true) ? "" : " (NOT the same bits)");
  }
  return text +
         "\nWhere `ms` is not below `all`, the stage saves nothing on that view. Boxes, order, tiles, fields "
         "and whole "
         "frames are timed by the clock.\n";
}

}  // namespace

Expected<void> write_trade_page(const TradeSession& session) {
  const std::filesystem::path path = session.trade.docs / "trade.md";
  const std::string before = read_page(path);
  const auto hard = tables_of(session, "hard"), soft = tables_of(session, "soft"),
             ao = tables_of(session, "ao");
  std::string page = head() + preset_section();
  page += hard.empty() ? section_of(before, "Hard shadows") : hard_section(session, hard);
  page += soft.empty() ? section_of(before, "Soft shadows") : soft_section(session, soft);
  page += ao.empty() ? section_of(before, "Ambient occlusion") : ao_section(session, ao);
  page += session.stages.empty() ? section_of(before, stages_title) : stages_section(session, session.stages);
  page += session.needs.empty() ? section_of(before, "Only what a scene requires")
                                : needs_section(session, session.needs);
  for (const TradeTable& table : session.tables) {
    const auto plot = session.trade.docs / fmt::format("trade_{}.svg", plot_name(table));
    if (auto written = base::write_file(plot, trade_plot(table)); !written) return written;
  }
  return base::write_file(path, page);
}

}  // namespace tenebra::bench
