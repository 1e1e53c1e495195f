// How much longer than usual a test waits for a program before it gives up.
#pragma once

namespace tenebra::testing {

/// Programs take several times as long under the sanitizers.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr double patience = 8;
#else
inline constexpr double patience = 1;
#endif

}  // namespace tenebra::testing
