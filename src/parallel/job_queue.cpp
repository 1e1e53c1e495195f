#include "parallel/job_queue.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/fail.h"

namespace tenebra::parallel {

struct JobQueue::State {
  std::size_t most_waiting = 1;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Job> waiting;
  bool busy = false;
  bool ends = false;
  std::optional<Error> failure;
  std::thread thread;

  void run();
  Expected<void> outcome() const {
    return failure ? Expected<void>(tl::unexpected(*failure)) : Expected<void>();
  }
};

namespace {

/// A job that runs out of memory has failed like any other.
Expected<void> outcome_of(const JobQueue::Job& job) {
  try {
    return job();
  } catch (const std::exception& error) {
    return base::fail("cannot go on: {}", error.what());
  }
}

}  // namespace

void JobQueue::State::run() {
  std::unique_lock lock(mutex);
  while (true) {
    changed.wait(lock, [this] { return ends || !waiting.empty(); });
    if (waiting.empty()) return;
    const Job job = std::move(waiting.front());
    waiting.pop_front();
    busy = true;
    const bool dropped = failure.has_value();
    lock.unlock();
    auto done = dropped ? Expected<void>() : outcome_of(job);
    lock.lock();
    busy = false;
    if (!done) failure = std::move(done.error());
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
  s.changed.wait(lock, [&s] { return s.waiting.size() < s.most_waiting || s.failure; });
  if (s.failure) return s.outcome();
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
