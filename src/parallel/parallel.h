// The one place for threads: loops and fork-join over oneTBB. Every body runs with IEEE defaults (round to
// nearest, no flush to zero), whatever the caller's floating-point environment.
#pragma once

#include <tenebra/threads.h>
#include <concepts>
#include <cstddef>

namespace tenebra::parallel {

/// Round to nearest and gradual underflow while it lives; the caller's settings come back with its end.
class FloatEnvironment {
public:
  FloatEnvironment();
  ~FloatEnvironment();
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

private:
  unsigned saved_;
};

/// A function that is there for as long as it is called: a reference to it, which takes no memory.
template <class... Arguments>
class Body {
public:
  template <std::invocable<Arguments...> Function>
  Body(const Function& function)  // NOLINT(google-explicit-constructor): calls name it in place
      : function_(&function), call_([](const void* of, Arguments... arguments) {
          (*static_cast<const Function*>(of))(arguments...);
        }) {}
  void operator()(Arguments... arguments) const { call_(function_, arguments...); }

private:
  const void* function_;
  void (*call_)(const void*, Arguments...);
};
using RangeBody = Body<std::size_t, std::size_t>;
using TaskBody = Body<int>;

/// Calls body(first, last) on ranges that cover 0..count, at most `grain` long each. The ranges depend on
/// `count` and `grain` only, never on the number of threads.
void parallel_ranges(std::size_t count, std::size_t grain, RangeBody body);

/// Calls body(0) ... body(count - 1), possibly at once; may be nested.
void parallel_tasks(int count, TaskBody body);

/// Calls the bodies in order: a thread that is free takes the next. For few of uneven length, longest first.
void parallel_in_order(int count, TaskBody body);

/// Index of the calling thread among those of the loop, in 0..thread_count() - 1; for per-thread scratch.
int thread_index();

}  // namespace tenebra::parallel
