#include "bench/common/bench_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/machine.h"
#include "base/statistics.h"
#include "io/output_file.h"

namespace tenebra::bench {
namespace {

/// A field of a CSV row; quoted where it holds what separates fields.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  return quoted + '"';
}

bool is_number(const std::string& text) {
  return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) || text[0] == '-');
}

}  // namespace

void progress(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::fflush(stderr);
}

Expected<void> Report::check() const {
  if (csv_.empty()) return {};
  const auto file = io::OutputFile::create(csv_);
  if (!file) return tl::unexpected(file.error());
  return {};
}

Expected<void> Report::write(std::span<const std::string> settings) const {
  if (csv_.empty()) return {};
  std::string text = fmt::format("# machine: {}\n", base::machine_description());
  for (const std::string& setting : settings) text += fmt::format("# {}\n", setting);
  text += "experiment,view,contestant,parameter,quantity,value,unit\n";
  for (const Figure& f : figures_) {
    text += fmt::format("{},{},{},{},{},{},{}\n", csv_field(f.experiment), csv_field(f.view),
                        csv_field(f.contestant), csv_field(f.parameter), csv_field(f.quantity), f.value,
                        csv_field(f.unit));
  }
  if (auto written = io::write_file(csv_, text); !written) return written;
  for (const auto& [name, svg] : plots_) {
    const auto path = csv_.parent_path() / fmt::format("{}_{}.svg", csv_.stem().string(), name);
    if (auto written = io::write_file(path, svg); !written) return written;
  }
  return {};
}

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool right = c > 0 && (is_number(row[c]) || &row == &rows.front());
      line += right ? fmt::format("{:>{}}  ", row[c], widths[c]) : fmt::format("{:<{}}  ", row[c], widths[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

void print_table(const std::string& title, const std::vector<std::vector<std::string>>& rows) {
  std::printf("\n%s\n%s", title.c_str(), text_table(rows).c_str());
  std::fflush(stdout);
}

double geometric_mean(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) {
    if (!(v > 0)) return 0;
    sum += std::log(v);
  }
  return values.empty() ? 0 : std::exp(sum / static_cast<double>(values.size()));
}

double median(std::span<const double> values) {
  return base::summarize(values).median;
}

std::string headline(const std::string& name, double value, int digits) {
  return fmt::format("{}: {}\n", name,
                     std::isnan(value) ? "not measured" : fmt::format("{:.{}f}", value, digits));
}

}  // namespace tenebra::bench
