// How many threads the computations of this library use.
#pragma once

#include <functional>

namespace tenebra {

/// Runs `body`; whatever it calls in this library uses at most `threads` threads (0: all cores).
void with_threads(int threads, const std::function<void()>& body);

/// How many threads a computation that is started here may use.
int thread_count();

}  // namespace tenebra
