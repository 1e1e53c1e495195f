// Stopping cleanly: Ctrl-C and `kill` wait until the work at hand is whole.
#pragma once

#include <atomic>
#include <csignal>
#include <thread>

#include <tenebra/stop_flag.h>

namespace tenebra::viewer {

/// While it lives, SIGINT, SIGTERM and SIGHUP are held back and asked for with `caught` instead of ending the
/// program; long work is given `flag` and ends early. Make it before other threads start: they inherit what
/// is held back.
class StopSignals {
public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// The signal that asked to stop so far; 0: none.
  int caught();
  /// Requested soon after a signal came.
  const StopFlag& flag() const { return flag_; }

private:
  void take();

  sigset_t held_{};
  sigset_t before_{};
  std::atomic<int> caught_{0};
  StopFlag flag_;
  std::jthread watcher_;
};

/// Exit code by convention: 130 for SIGINT, 143 for SIGTERM.
inline int exit_code_of(int signal) {
  return 128 + signal;
}

}  // namespace tenebra::viewer
