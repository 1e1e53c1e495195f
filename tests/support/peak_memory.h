// What memory a test took.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace tenebra::testing {

/// The most that this process has held at one time, in bytes; 0 where the system doesn't say.
inline std::uint64_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  return 0;
}

}  // namespace tenebra::testing
