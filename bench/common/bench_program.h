// The program that was built beside tenebra-bench, for what is measured from outside.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tenebra::bench {

/// Empty: there is none.
inline std::filesystem::path program_file() {
  std::error_code error;
  const auto own = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = own.parent_path() / "tenebra";
  return !error && std::filesystem::is_regular_file(beside, error) ? beside : std::filesystem::path();
}

/// `arguments` with the settings of the library, which figures are defined at, instead of the program's own.
inline std::vector<std::string> with_library_settings(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--antialias", "1", "--terminator", "flat", "--tone", "none"});
  return arguments;
}

}  // namespace tenebra::bench
