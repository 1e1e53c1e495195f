#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <tenebra/threads.h>

namespace tenebra {

void with_threads(int threads, const std::function<void()>& body) {
  if (threads <= 0) {
    body();
    return;
  }
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute(body);
}

int thread_count() {
  return tbb::this_task_arena::max_concurrency();
}

}  // namespace tenebra
