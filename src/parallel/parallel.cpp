#include "parallel/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstdint>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

// The names are the sanitizer's. NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)
#ifdef TENEBRA_THREAD_SANITIZER
extern "C" void __tsan_acquire(void*);
extern "C" void __tsan_release(void*);
#else
namespace {
void __tsan_acquire(void*) {}
void __tsan_release(void*) {}
}  // namespace
#endif
// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)

namespace tenebra::parallel {

namespace {

#ifdef __SSE__
constexpr unsigned ieee_defaults = 0x1f80;  // MXCSR: all exceptions masked, to nearest, no FTZ, no DAZ
unsigned float_settings() {
  return _mm_getcsr();
}
void set_float_settings(unsigned settings) {
  _mm_setcsr(settings);
}
#elif defined(__aarch64__)
constexpr unsigned ieee_defaults = 0;  // FPCR: no traps, to nearest, no FZ; its upper half is not in use
unsigned float_settings() {
  std::uint64_t settings = 0;
  asm volatile("mrs %0, fpcr" : "=r"(settings));
  return static_cast<unsigned>(settings);
}
void set_float_settings(unsigned settings) {
  asm volatile("msr fpcr, %0" : : "r"(std::uint64_t{settings}));
}
#endif

// What a loop is to the thread sanitizer: libtbb is not instrumented, nor is this file, so the order that
// they keep (the caller before each body, each body before the caller goes on) has to be said.
class Loop {
public:
  Loop() { __tsan_release(this); }
  ~Loop() { __tsan_acquire(this); }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  template <class Body>
  void run(const Body& body) {
    __tsan_acquire(this);
    const FloatEnvironment ieee;
    body();
    __tsan_release(this);
  }
};

}  // namespace

FloatEnvironment::FloatEnvironment() : saved_(float_settings()) {
  set_float_settings(ieee_defaults);
}
FloatEnvironment::~FloatEnvironment() {
  set_float_settings(saved_);
}

void parallel_ranges(std::size_t count, std::size_t grain, RangeBody body) {
  const std::size_t ranges = (count + grain - 1) / grain;
  Loop loop;
  tbb::parallel_for(std::size_t{0}, ranges, [&](std::size_t i) {
    loop.run([&] { body(i * grain, std::min(count, (i + 1) * grain)); });
  });
}

void parallel_tasks(int count, TaskBody body) {
  Loop loop;
  tbb::parallel_for(0, count, [&](int i) { loop.run([&] { body(i); }); });
}

void parallel_in_order(int count, TaskBody body) {
  std::atomic<int> next{0};
  parallel_tasks(std::min(count, thread_count()), [&](int) {
    for (int i = next++; i < count; i = next++) body(i);
  });
}

int thread_index() {
  return std::max(0, tbb::this_task_arena::current_thread_index());
}

}  // namespace tenebra::parallel
