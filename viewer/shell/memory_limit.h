// A bound on the memory of the whole program, kept by the system.
#pragma once

#include <optional>

#include <tenebra/expected.h>

namespace tenebra::viewer {

/// From here on the program gets no more than that, of 2^20 bytes each: what it asks for in any way to write
/// to, used or not, with the stacks of threads, and without its own code and what files map. What exceeds it
/// fails as where no memory is left. A limit that the system has set already stays where it is smaller.
Expected<void> limit_memory(std::optional<int> memory_mb);

/// Whether so little is left of that limit that a call for memory may well have failed. For signal handlers,
/// too.
bool near_memory_limit();

/// What limit_memory() or the shell (ulimit -d) has set.
std::optional<long> memory_limit_mb();

}  // namespace tenebra::viewer
