// One run of `tenebra-bench viewer`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/common/bench_session.h"
#include "bench/viewer/watched_viewer.h"

namespace tenebra::bench {

/// The last lines; parts that were left out leave theirs empty.
struct ViewerHeadline {
  std::optional<double> pictures_per_second_worst, black_ms_worst, explain_ms, over_render;
  std::optional<double> key_to_picture;  ///< in frames of `tenebra render`
};

constexpr double picture_patience_s = 300;  ///< a whole one with soft shadows from nearby takes over a minute

struct ViewerSession : BenchSession {
  ViewerSession(const PartsArguments& arguments, std::string program_file, WatchedScreen& watched)
      : BenchSession(arguments), program(std::move(program_file)), screen(watched) {}

  std::string program;
  WatchedScreen& screen;
  ViewerHeadline headline;

  int side() const { return effort == Effort::tiny ? 128 : 1024; }  ///< of pictures, in pixels
  void add_black(double seconds) {
    headline.black_ms_worst = std::max(headline.black_ms_worst.value_or(0), 1e3 * seconds);
  }
};

// The parts.
Expected<void> measure_hands(ViewerSession& session);   ///< held keys and drags
Expected<void> measure_starts(ViewerSession& session);  ///< until there is a picture
Expected<void> measure_opens(ViewerSession& session);   ///< the same for a file opened in the window
Expected<void> measure_whole(ViewerSession& session);   ///< whole frames beside `tenebra render`'s
Expected<void> measure_explain(ViewerSession& session);

}  // namespace tenebra::bench
