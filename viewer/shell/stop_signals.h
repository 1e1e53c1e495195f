// Stopping cleanly: Ctrl-C, `kill` and --timeout wait until the current work is complete, but not forever.
#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <limits>
#include <thread>

#include <tenebra/stop_flag.h>

namespace tenebra::viewer {

/// While it lives, SIGINT, SIGTERM and SIGHUP are held back and asked for with `caught` instead of ending the
/// program; long work is given `flag` and ends early. A second signal ends the program at once, and so does
/// half a second in which the first was not obeyed: work that blocks cannot see the flag, and some does not
/// look at it often enough. Files are then whole or absent all the same (OutputFile, Journal). Make it before
/// other threads start: they inherit what is held back.
class StopSignals {
public:
  /// at_once: the first request ends the program, as a second one does later: nothing is written yet, and no
  /// work looks at the flag.
  enum class Start { orderly, at_once };

  /// `timeout_s`: after this many seconds it is as if a signal came.
  explicit StopSignals(double timeout_s = std::numeric_limits<double>::infinity(),
                       Start start = Start::orderly);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Ends Start::at_once: from here on work looks at the flag.
  void be_orderly() { orderly_ = true; }

  /// The signal that asked to stop so far; 0: none.
  int caught();
  /// Requested soon after a signal came or the time was up.
  const StopFlag& flag() const { return flag_; }
  /// For a program that was stopped: 128 + the signal, or 124 if its time was up.
  int exit_code();

private:
  using Clock = std::chrono::steady_clock;

  void take();
  void watch_time();
  void request(int code);

  sigset_t held_{};
  sigset_t before_{};
  double timeout_s_;
  Clock::time_point begin_ = Clock::now();
  std::atomic<bool> orderly_;
  std::atomic<int> caught_{0};
  std::atomic<int> code_{0};  ///< exit code of the first request; 0: none
  std::atomic<Clock::duration::rep> last_moment_{Clock::duration::max().count()};  ///< since begin_
  StopFlag flag_;
  std::jthread watcher_;
};

}  // namespace tenebra::viewer
