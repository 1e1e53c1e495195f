// Where long calls run: beside Python, which looks at Ctrl-C and reports progress meanwhile. No Python here.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include <tenebra/expected.h>

namespace tenebra::python {

/// A thread that is kept for the calls of one object: what libraries keep by thread (oneTBB's arena, the
/// memory that malloc has at hand) is then there in the next call. Started by the first. One call at a time.
class Beside {
public:
  Beside();
  ~Beside();
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  /// Does `job` and returns what it returned, or throws what it threw. While that takes, calls `meanwhile`
  /// on this thread every so often.
  Expected<void> run(const std::function<Expected<void>()>& job, std::chrono::milliseconds every,
                     const std::function<void()>& meanwhile);

private:
  struct Thread;
  std::unique_ptr<Thread> thread_;
};

}  // namespace tenebra::python
