// One light of one view, with allowed errors beside exact.
#pragma once

#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "bench/common/bench_report.h"
#include "session/session.h"

namespace tenebra::bench {

struct PromiseView {
  std::string name;
  int light = 0;
  bool sun = false;
  double size = 0;  ///< of the light: percent of the diagonal; of a sun: degrees
  int rounds = 0;   ///< of times; 0: none
};

struct PromiseRun {
  std::string view;
  double asked, rms, estimate;  ///< 1/255 of white
  std::size_t penumbra;         ///< pixels
  bool sampled;                 ///< else all is exact, and times alone count
  double over_exact = 0;        ///< time over that of exact
  double over_smaller = 0;      ///< and of the next smaller error
  double estimate_off() const;  ///< as a ratio of at least 1
};

struct PromiseTable {
  std::vector<PromiseRun> runs;

  void print(bool with_times) const;
  void add_to(Report& report) const;
};

/// Of what the session has placed.
Expected<void> measure_view(session::Session& session, const PromiseView& view, PromiseTable& table);

}  // namespace tenebra::bench
