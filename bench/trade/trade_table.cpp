#include "bench/trade/trade_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/common/bench_plot.h"

namespace tenebra::bench {
namespace {

/// On the `i`-th number of threads.
bool beats(const TradePoint& a, const TradePoint& b, std::size_t i, double none_below) {
  const double error_a = std::max(a.errors[0], none_below), error_b = std::max(b.errors[0], none_below);
  const double ms_a = a.times[i].ms, ms_b = b.times[i].ms;
  return ms_a <= ms_b && error_a <= error_b && (ms_a < ms_b || error_a < error_b);
}

std::string title_of(const ErrorColumn& column) {
  return column.unit.empty() ? column.name : fmt::format("{} ({})", column.name, column.unit);
}

}  // namespace

const TradePoint* TradeTable::find(const std::string& name) const {
  const auto found =
      std::find_if(points.begin(), points.end(), [&](const TradePoint& p) { return p.name() == name; });
  return found == points.end() ? nullptr : &*found;
}

std::string method_title(const std::string& method) {
  return method == "ao" ? "ambient occlusion" : method + " shadows";
}

void mark_front(std::vector<TradePoint>& points, double none_below) {
  for (TradePoint& point : points) {
    for (std::size_t i = 0; i < point.times.size(); ++i)
      point.times[i].front = std::none_of(points.begin(), points.end(), [&](const TradePoint& other) {
        return beats(other, point, i, none_below);
      });
  }
}

void add_figures(const TradeTable& table, Report& report) {
  for (const TradePoint& p : table.points) {
    const auto add = [&](const std::string& quantity, double value, const std::string& unit) {
      report.add({"trade " + table.method, table.view, p.family, p.setting, quantity, value, unit});
    };
    for (const TradeTime& time : p.times)
      add(fmt::format("time on {}", threads_text(time.threads)), time.ms, "ms");
    add("memory", p.mb, "MB");
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      add(table.columns[i].name, p.errors[i], table.columns[i].unit);
    for (const TradeTime& time : p.times)
      add(fmt::format("front on {}", threads_text(time.threads)), time.front ? 1 : 0, "");
  }
}

std::string trade_text(const TradeTable& table) {
  std::vector<std::string> head{"setting"};
  for (const TradeTime& time : table.points.front().times)
    head.push_back(fmt::format("ms, {}", threads_text(time.threads)));
  head.emplace_back("MB");
  for (const ErrorColumn& column : table.columns) head.push_back(title_of(column));
  std::vector<const TradePoint*> sorted;
  for (const TradePoint& p : table.points) sorted.push_back(&p);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const TradePoint* a, const TradePoint* b) { return a->ms() < b->ms(); });
  std::vector<std::vector<std::string>> rows{head};
  for (const TradePoint* p : sorted) {
    rows.push_back({p->name()});
    for (const TradeTime& time : p->times)
      rows.back().push_back((time.front ? "* " : "") + short_number(time.ms));
    rows.back().push_back(short_number(p->mb));
    for (const double error : p->errors) rows.back().push_back(short_number(error));
  }
  return text_table(rows);
}

std::string trade_plot(const TradeTable& table) {
  std::vector<Curve> families;
  Curve front{"Pareto front", {}};
  for (const TradePoint& p : table.points) {
    auto curve =
        std::find_if(families.begin(), families.end(), [&](const Curve& c) { return c.name == p.family; });
    if (curve == families.end()) curve = families.insert(curve, Curve{p.family, {}});
    curve->points.emplace_back(p.ms(), p.errors[0]);
    if (p.times.front().front) front.points.emplace_back(p.ms(), p.errors[0]);
  }
  std::sort(front.points.begin(), front.points.end());
  return scatter_plot(fmt::format("{}: time and error of {}", table.view, method_title(table.method)),
                      fmt::format("time (ms, {})", threads_text(table.points.front().times.front().threads)),
                      title_of(table.columns[0]), table.none_below, families, front);
}

std::string threads_text(int threads) {
  return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
}

std::string plot_name(const TradeTable& table) {
  std::string name = fmt::format("{}_{}", table.method, table.view);
  std::replace(name.begin(), name.end(), ' ', '_');
  std::erase(name, ',');
  return name;
}

std::string short_number(double value) {
  if (value == 0) return "0";
  if (!std::isfinite(value)) return fmt::format("{}", value);
  const double size = std::abs(value);
  if (size >= 100 || value == std::floor(value)) return fmt::format("{:.0f}", value);
  if (size < 1e-3) return fmt::format("{:.0e}", value);
  const int before = static_cast<int>(std::floor(std::log10(size)));
  return fmt::format("{:.{}f}", value, std::max(0, 2 - before));
}

}  // namespace tenebra::bench
