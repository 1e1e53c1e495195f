#include "beside.h"

#include <unistd.h>

#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>

namespace tenebra::python {

using Task = std::packaged_task<Expected<void>()>;

struct Beside::Thread {
  std::mutex mutex;
  std::condition_variable wake;
  Task task;          ///< the next; invalid: none
  bool over = false;  ///< there is no next one
  pid_t process = getpid();
  std::thread thread{[this] { work(); }};  // the last member: the others are there when it starts

  void work() {
    for (;;) {
      std::unique_lock lock(mutex);
      wake.wait(lock, [&] { return over || task.valid(); });
      if (over) return;
      Task mine = std::move(task);
      task = {};
      lock.unlock();
      mine();
    }
  }

  void change(const std::function<void()>& how) {
    {
      const std::lock_guard lock(mutex);
      how();
    }
    wake.notify_one();
  }
  ~Thread() {
    change([&] { over = true; });
    thread.join();
  }
};

Beside::Beside() = default;

// After a fork the child has a copy of all this, but not the thread: to wait for it would be to wait for
// ever.
Beside::~Beside() {
  if (thread_ && thread_->process != getpid()) static_cast<void>(thread_.release());
}

Expected<void> Beside::run(const std::function<Expected<void>()>& job, std::chrono::milliseconds every,
                           const std::function<void()>& meanwhile) {
  if (thread_ && thread_->process != getpid()) static_cast<void>(thread_.release());
  if (!thread_) thread_ = std::make_unique<Thread>();
  Task task(job);
  auto result = task.get_future();
  thread_->change([&] { thread_->task = std::move(task); });
  // The job works on what the caller holds: however this is left, as by a thread that Python ends, it has
  // ended.
  const auto wait = [](std::future<Expected<void>>* of) {
    if (of->valid()) of->wait();
  };
  const std::unique_ptr<std::future<Expected<void>>, decltype(wait)> ended(&result, wait);
  while (result.wait_for(every) != std::future_status::ready) meanwhile();
  return result.get();
}

}  // namespace tenebra::python
