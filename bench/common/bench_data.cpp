#include "bench/common/bench_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "support/child_process.h"

namespace tenebra::bench {
namespace {

constexpr std::array folders{"robots", "museum", "kitchen"};
constexpr const char* sums = TENEBRA_SCENES_DIR "/../tests/reference/bart.sha256";
constexpr std::size_t most_named = 3;

/// Lines of `sha256sum --check`: "robots/city.aff: FAILED", or "FAILED open or read" where there is none.
std::vector<std::string> files_that_differ(const std::filesystem::path& folder) {
  const auto result = testing::run_program({"/usr/bin/env", "LC_ALL=C", "sh", "-c",
                                            "cd \"$0\" && exec sha256sum --quiet --check \"$1\"",
                                            folder.string(), std::filesystem::absolute(sums).string()});
  std::vector<std::string> files;
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line);)
    if (const auto end = line.find(": FAILED"); end != std::string::npos)
      files.push_back(line.substr(0, end));
  return files;
}

}  // namespace

std::vector<std::string> data_sentences(const std::filesystem::path& folder) {
  std::error_code ignored;
  const auto is_there = [&](const char* name) {
    return std::filesystem::is_directory(folder / name, ignored);
  };
  if (std::none_of(folders.begin(), folders.end(), is_there)) {
    return {fmt::format(
        "BART is not in {}: its scenes are skipped, the bundled ones are measured. It comes from its "
        "authors' page (www.cse.chalmers.se/~uffe/BART/, public domain); --data FOLDER names the folder "
        "that has {}.",
        folder.string(), fmt::join(folders, ", "))};
  }
  std::vector<std::string> files = files_that_differ(folder);
  if (files.empty()) return {};
  const std::size_t count = files.size();
  files.resize(std::min(count, most_named));
  return {
      fmt::format("{}: {} of BART's files are missing or differ from those of the documented figures ({}{}).",
                  folder.string(), count, fmt::join(files, ", "), count > most_named ? ", ..." : "")};
}

}  // namespace tenebra::bench
