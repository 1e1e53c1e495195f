#include "parallel/job_queue.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace tenebra::parallel {

struct JobQueue::State {
  std::size_t most_waiting = 1;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Job> waiting;
  bool busy = false;
  bool ends = false;
  std::optional<Error> failure;
  std::exception_ptr thrown;  ///< by a job, kept for the caller
  std::thread thread;

  void run();
  bool failed() const { return failure || thrown; }
  Expected<void> outcome() const {
    if (thrown) std::rethrow_exception(thrown);
    return failure ? Expected<void>(tl::unexpected(*failure)) : Expected<void>();
  }
};

void JobQueue::State::run() {
  std::unique_lock lock(mutex);
  while (true) {
    changed.wait(lock, [this] { return ends || !waiting.empty(); });
    if (waiting.empty()) return;
    const Job job = std::move(waiting.front());
    waiting.pop_front();
    busy = true;
    const bool dropped = failed();
    lock.unlock();
    Expected<void> done;
    std::exception_ptr caught;
    try {
      if (!dropped) done = job();
    } catch (...) {
      caught = std::current_exception();
    }
    lock.lock();
    busy = false;
    if (!done) failure = std::move(done.error());
    if (caught) thrown = caught;
    changed.notify_all();
  }
}

JobQueue::JobQueue(std::size_t most_waiting) : state_(std::make_unique<State>()) {
  state_->most_waiting = most_waiting;
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

JobQueue::~JobQueue() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ends = true;
  }
  state_->changed.notify_all();
  state_->thread.join();
}

Expected<void> JobQueue::add(Job job) {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  s.changed.wait(lock, [&s] { return s.waiting.size() < s.most_waiting || s.failed(); });
  if (s.failed()) return s.outcome();
  s.waiting.push_back(std::move(job));
  s.changed.notify_all();
  return {};
}

Expected<void> JobQueue::finish() {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  s.changed.wait(lock, [&s] { return s.waiting.empty() && !s.busy; });
  return s.outcome();
}

}  // namespace tenebra::parallel
