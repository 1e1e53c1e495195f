// Runs jobs in order on another thread, beside the caller's work: files are written while the next frame is
// computed.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include <tenebra/expected.h>

namespace tenebra::parallel {

/// A thread that does what is added. After a job has failed, those behind it are dropped.
class JobQueue {
public:
  using Job = std::function<Expected<void>()>;

  /// At most `most_waiting` (1 or more) jobs wait, beside the one being done.
  explicit JobQueue(std::size_t most_waiting);
  ~JobQueue();  ///< finishes
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// Waits until there is room. Fails with what a job before failed with, and throws what it threw.
  Expected<void> add(Job job);
  /// Waits until all is done. Fails and throws likewise.
  Expected<void> finish();

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tenebra::parallel
