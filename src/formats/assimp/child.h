// Another program, run for what it writes.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace tenebra::formats {

struct ChildLimits {
  std::size_t output_bytes = 0;
  std::chrono::milliseconds time{};  ///< by the clock on the wall
};

struct ChildResult {
  enum class End { exit, signal, too_long, too_much };  ///< the last two: it was killed for it
  End end = End::exit;
  int number = 0;      ///< exit code or signal
  std::string output;  ///< standard output, at most ChildLimits::output_bytes
  std::string errors;  ///< standard error, at most 64 KiB
};

/// Runs `program` with `words` behind its name and without standard input, and waits until it ended; it never
/// outlives this call. Throws ImportFailure where it cannot be started.
ChildResult run_child(const std::filesystem::path& program, const std::vector<std::string>& words,
                      const ChildLimits& limits);

}  // namespace tenebra::formats
