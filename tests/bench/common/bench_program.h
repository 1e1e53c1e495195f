// The program that was built beside tenebra-bench, for what is measured from outside.
#pragma once

#include <filesystem>

namespace tenebra::bench {

/// Empty: there is none.
inline std::filesystem::path program_file() {
  std::error_code error;
  const auto own = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = own.parent_path() / "tenebra";
  return !error && std::filesystem::is_regular_file(beside, error) ? beside : std::filesystem::path();
}

}  // namespace tenebra::bench
