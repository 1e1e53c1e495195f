#include "log/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "log/charts.h"
#include "log/log_summary.h"
#include "log/page_text.h"
#include "log/report_style.h"

namespace tenebra::viewer {
namespace {

constexpr const char* letters[] = {"A", "B"};
constexpr const char* classes[] = {"a", "b"};

/// A log as the page has it.
struct Run {
  const LogFile* log = nullptr;
  LogSummary summary;
};

std::string head(const std::vector<Run>& runs) {
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Frame times: {}</title>\n<style>{}</style></head><body>\n<h1>Frame times</h1>\n",
      page_text(runs.front().log->setting("scene")), report_style);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const LogFile& log = *runs[i].log;
    text += fmt::format(
        "<p><b class=\"{}\">{}</b> {}: {}, {} pixels, {} frames, shadows {} <span class=\"dim\">{}"
        "</span></p>\n",
        classes[i], letters[i], page_text(log.name), page_text(log.setting("scene")),
        page_text(log.setting("size")), log.frames.size(), page_text(log.setting("shadows")),
        page_text(log.setting("machine")));
  }
  for (const Run& run : runs)
    for (const std::string& remark : run.log->remarks)
      text += fmt::format("<p class=\"dim\">{}.</p>\n", page_text(remark));
  return text;
}

std::string total_section(const std::vector<Run>& runs) {
  std::vector<ChartedLog> charted;
  std::string legend;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    charted.push_back({letters[i], runs[i].log});
    legend += fmt::format("<span><i class=\"i{}\" style=\"background:var(--{})\"></i>{}</span>", i,
                          classes[i], letters[i]);
  }
  return fmt::format(
      "<h2>Over the animation</h2>\n<p class=\"legend\">{}<span class=\"dim\">ring: first frame of a chunk; "
      "triangle: "
      "beyond the scale</span></p>\n{}",
      legend, total_chart(charted));
}

const ColumnSummary* found_in(const std::vector<ColumnSummary>& columns, const std::string& name) {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const ColumnSummary& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

/// Names of both runs' columns, in the order of the first that has them.
std::vector<std::string> names_of(const std::vector<Run>& runs,
                                  std::vector<ColumnSummary> LogSummary::*columns) {
  std::vector<std::string> names;
  for (const Run& run : runs)
    for (const ColumnSummary& column : run.summary.*columns)
      if (std::find(names.begin(), names.end(), column.name) == names.end()) names.push_back(column.name);
  // The whole frame stays last.
  std::stable_partition(names.begin(), names.end(),
                        [](const std::string& name) { return name != "total_ms"; });
  return names;
}

std::string ratio_cell(const ColumnSummary* a, const ColumnSummary* b) {
  if (a == nullptr || b == nullptr || !(a->values.median > 0)) return "<td></td>";
  return fmt::format("<td>{:.2f}</td>", b->values.median / a->values.median);
}

std::string table_head(const std::vector<Run>& runs, std::string_view what) {
  std::string text = fmt::format("<tr><th>{}</th>", what);
  for (std::size_t i = 0; i < runs.size(); ++i)
    text += fmt::format(
        "<th><span class=\"{}\">{}</span> median</th><th>95 %</th><th>99 %</th><th>worst</th><th>at "
        "frame</th>",
        classes[i], letters[i]);
  return text + (runs.size() > 1 ? "<th>B / A</th>" : "") + "</tr>\n";
}

std::string table_of(const std::vector<Run>& runs, std::vector<ColumnSummary> LogSummary::*columns,
                     std::string_view what, int decimals) {
  std::string text = "<div class=\"scroll\"><table>\n" + table_head(runs, what);
  for (const std::string& name : names_of(runs, columns)) {
    const bool is_time = name.ends_with("_ms");
    std::vector<const ColumnSummary*> cells;
    cells.reserve(runs.size());
    for (const Run& run : runs) cells.push_back(found_in(run.summary.*columns, name));
    const bool has_history = std::any_of(
        cells.begin(), cells.end(), [](const ColumnSummary* c) { return c != nullptr && c->has_history; });
    text += fmt::format("<tr{}><td>{}{}</td>", name == "total_ms" ? " class=\"total\"" : "",
                        page_text(is_time ? name.substr(0, name.size() - 3) : name), has_history ? " *" : "");
    for (const ColumnSummary* cell : cells) {
      if (cell == nullptr)
        text += "<td></td><td></td><td></td><td></td><td></td>";
      else
        text += fmt::format("<td>{:.{}f}</td><td>{:.{}f}</td><td>{:.{}f}</td><td>{:.{}f}</td><td>{}</td>",
                            cell->values.median, decimals, cell->values.percentile_95, decimals,
                            cell->values.percentile_99, decimals, cell->values.worst, decimals,
                            cell->worst_frame);
    }
    text += (runs.size() > 1 ? ratio_cell(cells[0], cells[1]) : "") + "</tr>\n";
  }
  return text + "</table></div>\n";
}

std::string first_frames_text(const std::vector<Run>& runs) {
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const LogSummary& summary = runs[i].summary;
    text += fmt::format("<p class=\"dim\">{}: ", letters[i]);
    text +=
        summary.counts_first_frames
            ? std::string(
                  "every frame is the first of its process or chunk, and counts because there are no others.")
            : fmt::format(
                  "not counted: {} first of a chunk, which build what later ones keep; median {:.2f} ms, "
                  "worst {:.2f} ms.",
                  summary.first_frames.size(), summary.first_total_ms.median, summary.first_total_ms.worst);
    text += "</p>\n";
  }
  return text;
}

std::string stages_section(const std::vector<Run>& runs) {
  std::vector<ChartedLog> charted;
  double worst = 0;
  for (const Run& run : runs) {
    charted.push_back({"", run.log});
    worst = std::max(worst, usual_worst_ms(*run.log));
  }
  const std::vector<std::string> stages = charted_stages(charted);
  std::string text = "<h2>Stages</h2>\n<p class=\"legend\">";
  for (std::size_t stage = stages.size(); stage-- > 0;) {
    const std::size_t colour = stage + 1 == stages.size() ? 9 : stage;
    text += fmt::format("<span><i class=\"stage{}\"></i>{}</span>", colour, page_text(stages[stage]));
  }
  text += "</p>\n";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    constexpr double too_small_to_read = 0.4;  // of the other's height
    const double own = usual_worst_ms(*runs[i].log);
    const bool has_own_scale = own < too_small_to_read * worst;
    text += fmt::format("<p><b class=\"{}\">{}</b>{}</p>\n{}", classes[i], letters[i],
                        has_own_scale ? " <span class=\"dim\">(a scale of its own)</span>" : "",
                        stage_chart(*runs[i].log, stages, has_own_scale ? own : worst));
  }
  return text;
}

std::string values_of(const LogFile& log, const std::string& name) {
  std::string text;
  for (const render::LogSetting& setting : log.settings)
    if (setting.name == name) text += (text.empty() ? "" : "\n") + setting.value;
  return text;
}

std::string settings_section(const std::vector<Run>& runs) {
  std::vector<std::string> names;
  for (const Run& run : runs)
    for (const render::LogSetting& setting : run.log->settings)
      if (std::find(names.begin(), names.end(), setting.name) == names.end()) names.push_back(setting.name);
  std::string same, different;
  for (const std::string& name : names) {
    std::set<std::string> values;
    std::string row = fmt::format("<td>{}</td>", page_text(name));
    for (const Run& run : runs) {
      values.insert(values_of(*run.log, name));
      row += fmt::format("<td>{}</td>", page_text(values_of(*run.log, name)));
    }
    (values.size() > 1 ? different : same) +=
        fmt::format("<tr{}>{}</tr>\n", values.size() > 1 ? " class=\"differs\"" : "", row);
  }
  const auto table = [&](const std::string& rows) {
    std::string top = "<tr><th>setting</th>";
    for (std::size_t i = 0; i < runs.size(); ++i)
      top += fmt::format("<th style=\"text-align:left\" class=\"{}\">{}</th>", classes[i], letters[i]);
    return "<table class=\"settings\">" + top + "</tr>\n" + rows + "</table>\n";
  };
  std::string text = "<h2>Settings</h2>\n";
  if (!different.empty()) text += "<p>These differ:</p>" + table(different);
  return text + fmt::format("<details{}><summary>{}</summary>{}</details>\n", runs.size() == 1 ? " open" : "",
                            runs.size() == 1 ? "All" : "The others, the same in both", table(same));
}

std::string pictures_section(const std::vector<PagePicture>& pictures) {
  if (pictures.empty()) return "";
  const bool two = !pictures.front().b.empty();
  std::string text = fmt::format(
      "<h2>Pictures</h2>\n<div class=\"pictures\"><p class=\"sides\"><span>{}</span><span "
      "class=\"which\"></span>{}</p>\n",
      two ? "<b class=\"a\">A</b>" : "", two ? "<b class=\"b\">B</b>" : "<span></span>");
  text += "<div class=\"view\" style=\"--cut:50%\"><img alt=\"the chosen frame\">";
  if (two) text += "<img class=\"over\" alt=\"the same of B\"><div class=\"cut\"></div>";
  text += "</div>\n";
  if (two)
    text +=
        "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"0.5\" aria-label=\"A to the left, B "
        "to the right\">\n";
  text += "</div><div class=\"strip\">\n";
  for (const PagePicture& picture : pictures) {
    text += fmt::format("<button type=\"button\"><img width=\"{}\" height=\"{}\" alt=\"\" src=\"{}\">",
                        picture.width, picture.height, picture.a);
    if (two) text += fmt::format("<img hidden alt=\"\" style=\"display:none\" src=\"{}\">", picture.b);
    text += fmt::format("frame {}</button>\n", picture.frame);
  }
  return text + fmt::format(
                    "</div>\n"
                    "<p class=\"dim\">Reduced to at most {} pixels across.</p>\n",
                    widest_page_picture);
}

}  // namespace

Expected<std::string> report_page(std::span<const LogFile> logs, const std::vector<PagePicture>& pictures) {
  std::vector<Run> runs;
  for (const LogFile& log : logs) {
    auto summary = summarize_log(log);
    if (!summary) return tl::unexpected(summary.error());
    runs.push_back({&log, std::move(*summary)});
  }
  std::string page = head(runs) + total_section(runs);
  page += "<h2>Percentiles</h2>\n" + table_of(runs, &LogSummary::times, "milliseconds", 2) +
          first_frames_text(runs);
  page += stages_section(runs) + pictures_section(pictures);
  page +=
      "<h2>Counts</h2>\n" + table_of(runs, &LogSummary::counts, "per frame", 0) +
      "<p class=\"dim\">* also depends on the frames before. None depends on the number of threads.</p>\n";
  page += settings_section(runs);
  if (!pictures.empty()) page += fmt::format("<script>{}</script>\n", report_script);
  return page + "</body></html>\n";
}

}  // namespace tenebra::viewer
