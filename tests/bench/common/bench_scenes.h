// The scenes that the measuring commands know by name, and where their files lie.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace tenebra::bench {

struct BenchScene {
  const char* name;
  const char* file;  ///< in the folder of BART, or of the bundled scenes
  bool bundled;
  std::vector<std::string> no_cast;
};

/// Of robots, museum5, kitchen, museum5x64, city, gallery and court the one of that name.
const BenchScene& bench_scene(const std::string& name);

/// Where the scene's file is; empty: nowhere. museum5x64 is not stored: its script makes it, in a folder that
/// goes with `made`.
std::filesystem::path find_scene(const BenchScene& scene, const std::filesystem::path& data,
                                 std::unique_ptr<testing::TemporaryFolder>& made);

}  // namespace tenebra::bench
