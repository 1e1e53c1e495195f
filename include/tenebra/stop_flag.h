// Asks a long computation to end early, from another thread.
#pragma once

#include <atomic>

namespace tenebra {

/// Set by one thread, read by those that work. A computation that is given a flag looks at it every few
/// milliseconds at least; if it is set, the computation drops what it has and says so in its result.
class StopFlag {
public:
  void request() { requested_.store(true, std::memory_order_relaxed); }  ///< from any thread
  void reset() { requested_.store(false, std::memory_order_relaxed); }   ///< before the next computation
  bool requested() const { return requested_.load(std::memory_order_relaxed); }  ///< since the last reset()

private:
  std::atomic<bool> requested_{false};
};
/// Whether there is a flag and it was requested.
inline bool stop_requested(const StopFlag* flag) {
  return flag != nullptr && flag->requested();
}

}  // namespace tenebra
