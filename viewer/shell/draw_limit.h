// A bound on the time of one computation.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include <tenebra/stop_flag.h>

namespace tenebra::viewer {

/// While it lives, its flag is requested once `limit_ms` (which may be infinite) are over, or soon after
/// `outer` is.
class DrawLimit {
public:
  DrawLimit(double limit_ms, const StopFlag& outer);
  const StopFlag& flag() const { return flag_; }

private:
  StopFlag flag_;
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread watcher_;  // last: it ends before what it uses
};

}  // namespace tenebra::viewer
