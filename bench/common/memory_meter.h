// What memory work takes, as the program itself counts it: all that is asked of the global operator new,
// which memory_meter.cpp replaces, and what libraries report. Unlike the pages that the system has given, it
// hardly changes from run to run: where threads share the work, by how they happen to share it.
#pragma once

#include <cstddef>

namespace tenebra::bench {

/// Counts memory that was got (or given back: negative) from elsewhere than operator new. From any thread.
void count_memory(std::ptrdiff_t bytes);

/// The most that was held at one time since its construction, beyond what was held then. One at a time.
class MemoryMeter {
public:
  MemoryMeter();
  double mb() const;  ///< 10^6 bytes

private:
  std::ptrdiff_t before_;
};

}  // namespace tenebra::bench
