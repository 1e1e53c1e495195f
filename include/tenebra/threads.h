// How many threads the computations of this library use.
#pragma once

#include <functional>

namespace tenebra {

/// Runs `body` so that the loops below use at most `threads` threads (0: all cores).
void with_threads(int threads, const std::function<void()>& body);

/// Threads that a loop started here may use.
int thread_count();

}  // namespace tenebra
