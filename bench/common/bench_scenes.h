// The scenes that the measuring commands know by name, and where their files lie.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "support/temporary_folder.h"

namespace tenebra::bench {

struct BenchScene {
  const char* name;
  const char* file;  ///< in the folder of BART, or of the bundled scenes
  bool bundled;
  std::vector<std::string> no_cast;
};

/// The scene of that name: robots, museum5, kitchen, museum5x64, city, gallery or court.
const BenchScene& bench_scene(const std::string& name);

/// Where the scene's file is; empty: nowhere. museum5x64 is not stored: its script makes it, in a folder that
/// goes with `made`.
std::filesystem::path find_scene(const BenchScene& scene, const std::filesystem::path& data,
                                 std::unique_ptr<testing::TemporaryFolder>& made);
/// The sentence at the end about a scene that was not found.
std::string skipped_sentence(const std::string& scene);

/// A frame of a scene that has a name.
struct ScenePlace {
  const char* scene;
  int frame;
};
/// Calls `body` for each place with the scene's file, one file there at a time. Scenes that are missing are
/// named in `skipped`. `data`: the folder of the scenes that are not ours, empty: where it lies.
Expected<void> for_each_place(std::span<const ScenePlace> places, const std::filesystem::path& data,
                              std::vector<std::string>& skipped,
                              const std::function<Expected<void>(const ScenePlace&, const BenchScene&,
                                                                 const std::filesystem::path&)>& body);

}  // namespace tenebra::bench
