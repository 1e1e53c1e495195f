#include "bench/common/bench_scenes.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "bench/common/bench_frame.h"
#include "bench/common/bench_report.h"
#include "support/child_process.h"

namespace tenebra::bench {
namespace {

std::filesystem::path make_museum5x64(const std::filesystem::path& data,
                                      std::unique_ptr<testing::TemporaryFolder>& made) {
  std::error_code ignored;
  if (!std::filesystem::exists(data / "museum" / "animart5.aff", ignored)) return {};
  progress("museum5x64: made by scenes/make_museum5x64.py");
  made = std::make_unique<testing::TemporaryFolder>();
  const auto result =
      testing::run_program({"/usr/bin/env", "python3", TENEBRA_SCENES_DIR "/make_museum5x64.py",
                            (data / "museum").string(), (made->path() / "museum5x64").string()});
  if (result.exit_code == 0) return *made / "museum5x64/museum5x64.aff";
  progress("museum5x64: " + result.errors);
  return {};
}

}  // namespace

const BenchScene& bench_scene(const std::string& name) {
  // The two triangles of the robots' sky lie below its light.
  static const std::array<BenchScene, 7> scenes{{{"robots", "robots/Robot.aff", false, {"city2.aff:69"}},
                                                 {"museum5", "museum/museum5.aff", false, {}},
                                                 {"kitchen", "kitchen/kitchen.aff", false, {}},
                                                 {"museum5x64", "museum5x64/museum5x64.aff", false, {}},
                                                 {"city", "city.glb", true, {}},
                                                 {"gallery", "gallery.glb", true, {}},
                                                 {"court", "court.glb", true, {}}}};
  const auto found =
      std::find_if(scenes.begin(), scenes.end(), [&](const BenchScene& s) { return s.name == name; });
  assert(found != scenes.end());
  return *found;
}

std::filesystem::path find_scene(const BenchScene& scene, const std::filesystem::path& data,
                                 std::unique_ptr<testing::TemporaryFolder>& made) {
  const auto folder = scene.bundled ? std::filesystem::path(TENEBRA_SCENES_DIR) : data;
  std::error_code ignored;
  if (std::filesystem::exists(folder / scene.file, ignored)) return folder / scene.file;
  return scene.name == std::string("museum5x64") ? make_museum5x64(data, made) : std::filesystem::path();
}

std::string skipped_sentence(const std::string& scene) {
  return scene + ": skipped, not there";
}

Expected<void> for_each_place(std::span<const ScenePlace> places, const std::filesystem::path& data,
                              std::vector<std::string>& skipped,
                              const std::function<Expected<void>(const ScenePlace&, const BenchScene&,
                                                                 const std::filesystem::path&)>& body) {
  for (const ScenePlace& place : places) {
    const BenchScene& known = bench_scene(place.scene);
    std::unique_ptr<testing::TemporaryFolder> made;
    const auto file = find_scene(known, bart_folder(data), made);
    if (file.empty()) {
      skipped.push_back(skipped_sentence(place.scene));
      continue;
    }
    if (auto done = body(place, known, file); !done) return done;
  }
  return {};
}

}  // namespace tenebra::bench
