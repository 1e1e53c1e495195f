// The hashes of whole scenes as lines of text: SCENE FRAME WHAT HASH.
#pragma once

#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/scene.h>
#include "bench/hash/hash_frame.h"

namespace tenebra::bench {

struct HashedScene {
  std::string name;  ///< as bench_scene knows it
  std::vector<int> frames;
};
/// The bundled scenes, then those of BART; 20 frames in all.
const std::vector<HashedScene>& hashed_scenes();
/// One frame of each, for tests.
std::vector<HashedScene> quickly_hashed_scenes();

struct HashLines {
  std::vector<std::string> lines;
  int differing =
      0;  ///< values that are not the same at all settings; each setting then has a line of its own
};

/// All chosen frames of a scene at all of `settings`, pictures `scale` times as large as usual.
Expected<HashLines> hash_scene(const Scene& scene, const HashedScene& chosen,
                               const std::vector<HashSetting>& settings, int scale);

std::string hash_line(const std::string& scene, int frame, const std::string& what, std::uint64_t hash);

}  // namespace tenebra::bench
