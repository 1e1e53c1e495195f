#include "shell/draw_limit.h"

#include <algorithm>
#include <chrono>

namespace tenebra::viewer {

DrawLimit::DrawLimit(double limit_ms, const StopFlag& outer) {
  using Clock = std::chrono::steady_clock;
  using Milliseconds = std::chrono::duration<double, std::milli>;
  static constexpr double look_ms = 5;  // at `outer`
  const auto begin = Clock::now();
  watcher_ = std::jthread([this, limit_ms, &outer, begin](const std::stop_token& ended) {
    std::unique_lock lock(mutex_);
    while (!ended.stop_requested() && !flag_.requested()) {
      const double left_ms = limit_ms - Milliseconds(Clock::now() - begin).count();
      if (left_ms <= 0 || outer.requested()) return flag_.request();
      ended_.wait_for(lock, ended, Milliseconds(std::min(left_ms, look_ms)), [] { return false; });
    }
  });
}

}  // namespace tenebra::viewer
