// Prefetches memory that will be needed soon. Any address is allowed: a wrong one only costs time.
#pragma once

#include <hwy/cache_control.h>

#include <cstddef>

namespace tenebra::simd {

/// The cache line of `at`. GCC takes a function that does nothing but prefetch for one without effect and
/// drops the calls to it: the empty statement has an effect.
inline void prefetch(const void* at) {
  hwy::Prefetch(static_cast<const unsigned char*>(at));
  asm volatile("");
}

/// All cache lines of `what`.
template <class T>
void prefetch_all(const T& what) {
  const auto* const at = reinterpret_cast<const unsigned char*>(&what);
  for (std::size_t line = 0; line < sizeof(T); line += 64) prefetch(at + line);
}

}  // namespace tenebra::simd
