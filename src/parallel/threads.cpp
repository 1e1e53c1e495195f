#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <tenebra/threads.h>

#include <algorithm>

namespace tenebra {
namespace {

constexpr int most_threads = 1024;  // a thread takes memory and time, and no machine has more cores

}  // namespace

void with_threads(int threads, const std::function<void()>& body) {
  if (threads <= 0) {
    body();
    return;
  }
  const int used = std::min(threads, most_threads);
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(used));
  tbb::task_arena arena(used);
  arena.execute(body);
}

int thread_count() {
  return tbb::this_task_arena::max_concurrency();
}

}  // namespace tenebra
