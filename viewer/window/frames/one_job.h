// Work that takes long, on a thread of its own: the window goes on, shows how far it is and may stop it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <tenebra/stop_flag.h>
#include "window/frames/within_memory.h"

namespace tenebra::viewer {

template <class Found>
struct JobStatus {
  bool running = false;
  double done = 0;  ///< 0..1
  double elapsed_s = 0;
  std::shared_ptr<const Found> found;  ///< the last; null: none yet
};

template <class Request, class Found>
class OneJob {
public:
  using Progress = std::function<void(double done)>;
  using Work = std::function<Expected<Found>(Request, const Progress&, const StopFlag&)>;

  /// `wake` is called on the job's thread when it is over.
  OneJob(Work work, std::function<void()> wake)
      : work_(std::move(work)), wake_(std::move(wake)), thread_([this] { run(); }) {}
  /// Stops what is under way and waits for it.
  ~OneJob() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
      stop_.request();
    }
    changed_.notify_all();
    thread_.join();
  }
  OneJob(const OneJob&) = delete;
  OneJob& operator=(const OneJob&) = delete;

  /// Begins anew.
  void begin(Request request) {
    const std::lock_guard lock(mutex_);
    request_ = std::move(request);
    failure_.clear();
    begun_ = std::chrono::steady_clock::now();
    if (status_.running) stop_.request();
    changed_.notify_all();
  }
  /// Soon; nothing is found.
  void stop() {
    const std::lock_guard lock(mutex_);
    request_.reset();
    if (status_.running) stop_.request();
  }
  /// And what was found is let go.
  void forget() {
    stop();
    const std::lock_guard lock(mutex_);
    status_.found.reset();
  }
  JobStatus<Found> status() const {
    const std::lock_guard lock(mutex_);
    JobStatus<Found> status = status_;
    status.running = status_.running || request_;
    if (status.running)
      status.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    return status;
  }
  /// Why the last one found nothing, once; empty: it was stopped, or it has found something.
  std::string take_failure() {
    const std::lock_guard lock(mutex_);
    return std::exchange(failure_, {});
  }

private:
  void note(double done) {
    const std::lock_guard lock(mutex_);
    status_.done = done;
  }
  void run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return quit_ || request_; });
      if (quit_) return;
      Request request = std::move(*request_);
      request_.reset();
      status_.running = true;
      status_.done = 0;
      stop_.reset();
      lock.unlock();
      auto result = within_memory(
          [&] {
            return work_(
                std::move(request), [this](double done) { note(done); }, stop_);
          },
          [] {});
      lock.lock();
      status_.running = false;
      if (result && !stop_.requested())
        status_.found = std::make_shared<Found>(std::move(*result));
      else if (!result && !stop_.requested())
        failure_ = result.error().message;
      lock.unlock();
      wake_();
      lock.lock();
    }
  }

  const Work work_;
  const std::function<void()> wake_;
  StopFlag stop_;

  mutable std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::optional<Request> request_;
  JobStatus<Found> status_;
  std::chrono::steady_clock::time_point begun_{};
  std::string failure_;
  bool quit_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace tenebra::viewer
