// One run of `tenebra-bench trade`: what its parts share and what they add to the documentation.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tenebra/threads.h>
#include "bench/common/bench_session.h"
#include "bench/trade/trade_contest.h"

namespace tenebra::bench {

/// Where a script and a reader find what was measured.
struct TradeOptions {
  std::filesystem::path docs;  ///< folder of trade.md and its plots; empty: none
};

/// What a stage that is not run, or shrunk, saves on one view.
struct NeedRow {
  std::string stage, view;
  std::string shrunk;              ///< what the frame's own needs leave: "985370 rays of 1048576 pixels"
  double with_ms = 0, all_ms = 0;  ///< as it is, and if all of it were done; 0: only counted
  std::optional<bool> same{};      ///< both gave the same bits; none: only one of them was run
  int threads = thread_count();
};

/// A whole frame as it is, and with one stage alone switched off.
struct StageRow {
  std::string stage, view;
  double ms = 0, without_ms = 0;
  double mb = 0, without_mb = 0;  ///< that the renderer and its frames take, at most
  std::optional<bool> same{};     ///< both gave the same bits; none: that is not promised
  int threads = thread_count();
};

struct TradeSession : BenchSession {
  using BenchSession::BenchSession;

  TradeOptions trade;
  std::vector<TradeTable> tables;
  std::vector<NeedRow> needs;
  std::vector<StageRow> stages;
  std::map<std::string, double> headline;  ///< "hard_default_wrong_pixels"; the largest of the views
  std::vector<std::string> notes;          ///< sentences

  /// One thread, and as many as the run may use.
  Turns turns() const;
  /// Calls `body` on as many threads as turns() says, one number after the other, until it fails.
  Expected<void> on_each_number_of_threads(const std::function<Expected<void>()>& body) const;
  void keep_largest(const std::string& name, double value) {
    const auto [kept, fresh] = headline.emplace(name, value);
    if (!fresh) kept->second = std::max(kept->second, value);
  }
  /// Marks the front of `table`, prints it and keeps it.
  void finish(TradeTable table);
};

/// trade.md and its plots, from what was measured. Fails where the folder cannot be written.
Expected<void> write_trade_page(const TradeSession& session);

// The parts.
Expected<void> measure_trade_hard(TradeSession& session);
Expected<void> measure_trade_soft(TradeSession& session);
Expected<void> measure_trade_ao(TradeSession& session);
Expected<void> measure_trade_stages(TradeSession& session);  ///< each stage switched off alone
Expected<void> measure_trade_needs(TradeSession& session);   ///< what frames do not need and do not pay for

}  // namespace tenebra::bench
