// The one place for threads: loops and fork-join over oneTBB. Every body runs with IEEE defaults (round to
// nearest, no flush to zero), whatever the caller's floating-point environment.
#pragma once

#include <tenebra/threads.h>
#include <cstddef>
#include <functional>

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

/// Calls body(first, last) on ranges that cover 0..count, at most `grain` long each. The ranges depend on
/// `count` and `grain` only, never on the number of threads.
void parallel_ranges(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(0) ... body(count - 1), possibly at once; may be nested.
void parallel_tasks(int count, const std::function<void(int)>& body);

/// The same; a thread that is free takes the next of them, in order. For few of uneven length, longest first.
void parallel_in_order(int count, const std::function<void(int)>& body);

/// Index of the calling thread among those of the loop, in 0..thread_count() - 1; for per-thread scratch.
int thread_index();

}  // namespace tenebra::parallel
