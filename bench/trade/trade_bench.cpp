// tenebra-bench trade: what accuracy costs, setting by setting, for every method; what frames do not need and
// do not pay for; and the page of the documentation that tells it.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <memory>

#include <tenebra/threads.h>
#include "base/fail.h"
#include "bench/trade/trade_session.h"
#include "io/output_file.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{
    BenchPart<TradeSession>{"hard", measure_trade_hard}, BenchPart<TradeSession>{"soft", measure_trade_soft},
    BenchPart<TradeSession>{"ao", measure_trade_ao}, BenchPart<TradeSession>{"stages", measure_trade_stages},
    BenchPart<TradeSession>{"needs", measure_trade_needs}};
const std::span<const BenchPart<TradeSession>> all_parts(parts);

/// Before minutes of measuring, not after them.
Expected<void> check(const TradeOptions& options) {
  if (options.docs.empty()) return {};
  std::error_code ignored;
  if (!std::filesystem::is_directory(options.docs, ignored))
    return base::fail("--docs: {} is not a folder, expected one to write trade.md to", options.docs.string());
  const auto page = io::OutputFile::create(options.docs / "trade.md");
  return page ? Expected<void>() : tl::unexpected(page.error());
}

Expected<void> measure(const PartsArguments& arguments, const TradeOptions& options) {
  if (auto fine = check(options); !fine) return fine;
  TradeSession session(arguments);
  session.trade = options;
  if (auto done = measure_and_write(arguments, all_parts, session); !done) return done;
  if (!options.docs.empty()) {
    if (auto written = write_trade_page(session); !written) return written;
  }
  print_end("trade", session.skipped, {});
  for (const std::string& note : session.notes) std::printf("note: %s.\n", note.c_str());
  for (const auto& [name, value] : session.headline) print_headline("trade." + name, value, 3);
  return {};
}

}  // namespace

Turns TradeSession::turns() const {
  Turns turns{{1}, by_effort(1, 3, 15), by_effort(0.0, 250.0, 4000.0)};
  if (thread_count() > 1) turns.threads.push_back(thread_count());
  return turns;
}

Expected<void> TradeSession::on_each_number_of_threads(const std::function<Expected<void>()>& body) const {
  Expected<void> done;
  for (const int threads : turns().threads) {
    with_threads(threads, [&] { done = body(); });
    if (!done) return done;
  }
  return done;
}

void TradeSession::finish(TradeTable table) {
  mark_front(table.points, table.none_below);
  add_figures(table, report);
  report.add_plot(plot_name(table), trade_plot(table));
  std::printf("\n%s, %s (* on the Pareto front)\n%s", method_title(table.method).c_str(), table.view.c_str(),
              trade_text(table).c_str());
  if (!table.remark.empty()) std::printf("%s\n", table.remark.c_str());
  std::fflush(stdout);
  tables.push_back(std::move(table));
}

void add_trade_command(CLI::App& program, Run& run) {
  const auto options = std::make_shared<TradeOptions>();
  add_parts_command(program, run, {"trade", "What accuracy costs, for every method and setting"},
                    part_names(all_parts),
                    [options](const PartsArguments& arguments) { return measure(arguments, *options); })
      .add_option("--docs", options->docs,
                  "Write trade.md and its plots, the page of the documentation;\nwith --only the sections of "
                  "other parts stay as they are")
      ->type_name("FOLDER");
}

}  // namespace tenebra::bench
