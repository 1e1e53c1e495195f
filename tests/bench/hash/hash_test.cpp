// The bits of the bundled scenes are those of tests/reference/hashes.txt, at every vector level of this
// machine and on one thread and two.
#include <fmt/format.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "bench/common/bench_frame.h"
#include "bench/common/bench_scenes.h"
#include "bench/hash/hash_lines.h"
#include "bench/hash/plain_raster.h"
#include "support/child_process.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {
namespace {

/// Hashes by "SCENE FRAME WHAT". Comments are skipped.
using Hashes = std::map<std::string, std::string>;

void add_hash(const std::string& line, Hashes& out) {
  const std::size_t space = line.rfind(' ');
  if (line.empty() || line[0] == '#' || space == std::string::npos) return;
  EXPECT_TRUE(out.emplace(line.substr(0, space), line.substr(space + 1)).second) << line << ": twice";
}

/// Of one frame: "city 50".
Hashes reference_of(const std::string& frame) {
  std::istringstream text(testing::read_text(std::filesystem::path(TENEBRA_REFERENCE_DIR) / "hashes.txt"));
  Hashes hashes;
  for (std::string line; std::getline(text, line);)
    if (line.starts_with(frame + " ")) add_hash(line, hashes);
  return hashes;
}

class BundledHashes : public ::testing::TestWithParam<std::string> {};

const HashedScene& hashed_scene(const std::string& name) {
  static const std::vector<HashedScene> scenes = quickly_hashed_scenes();
  return *std::find_if(scenes.begin(), scenes.end(),
                       [&](const HashedScene& scene) { return scene.name == name; });
}

TEST_P(BundledHashes, AreThoseOfTheReference) {
  const HashedScene& chosen = hashed_scene(GetParam());
  const auto scene = load_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / bench_scene(GetParam()).file);
  ASSERT_TRUE(scene) << scene.error().message;
  const auto found = hash_scene(*scene, chosen, few_hash_settings(), 1);
  ASSERT_TRUE(found) << found.error().message;
  Hashes expected = reference_of(fmt::format("{} {}", chosen.name, chosen.frames[0])), hashes;
  ASSERT_FALSE(expected.empty()) << "tests/reference/hashes.txt has nothing of this frame";
  if (found->differing != 0) {
    for (const std::string& line : found->lines) ADD_FAILURE() << line;
    FAIL() << "values depend on the vector level or the number of threads";
  }
  for (const std::string& line : found->lines) add_hash(line, hashes);
  for (const auto& [what, hash] : hashes) {
    EXPECT_EQ(hash, expected[what]) << what << ": not the bits of tests/reference/hashes.txt";
    expected.erase(what);
  }
  for (const auto& [what, hash] : expected) ADD_FAILURE() << what << ": in the reference, but not computed";
}

std::vector<std::string> bundled_scenes() {
  std::vector<std::string> names;
  for (const HashedScene& scene : hashed_scenes())
    if (bench_scene(scene.name).bundled) names.push_back(scene.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, BundledHashes, ::testing::ValuesIn(bundled_scenes()),
                         [](const auto& info) { return info.param; });

/// Two triangles that share the diagonal of a square at z = -2, the same once more behind, and once more in
/// the same place.
struct Squares {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  Squares() {
    for (const float z : {-3.0f, -2.0f, -2.0f}) {
      const auto i = static_cast<unsigned>(positions.size());
      positions.insert(positions.end(), {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}});
      triangles.insert(triangles.end(), {{i, i + 1, i + 2}, {i, i + 2, i + 3}});
    }
  }
};

TEST(PlainRaster, SeesTheNearestAndOfEqualOnesTheFirst) {
  const Squares squares;
  const TriangleView triangles{squares.positions, squares.triangles, {}};
  constexpr int size = 33;
  const ViewRays view = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1.2f, 0.1f, size, size);
  const auto ids = plainly_seen_triangles(triangles, view, size, size);
  EXPECT_EQ(ids[0], no_triangle);
  for (int i = 8; i < size - 8; ++i) {
    for (int k = 8; k < size - 8; ++k) {
      const std::uint32_t id = ids[static_cast<std::size_t>(i * size + k)];
      const int up = size - 1 - i;
      EXPECT_TRUE(id == 2 || id == 3) << k << " " << i << ": " << id;
      if (k != up) {
        EXPECT_EQ(id, k > up ? 2u : 3u) << k << " " << i;
      }
    }
  }
}

TEST(PlainRaster, SeesNothingBeforeTheNearPlane) {
  const Squares squares;
  const TriangleView triangles{squares.positions, squares.triangles, {}};
  for (const auto& [near_m, seen] : {std::pair{2.5f, 0u}, std::pair{3.5f, no_triangle}}) {
    const ViewRays view = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.1f, near_m, 4, 4);
    EXPECT_EQ(plainly_seen_triangles(triangles, view, 4, 4)[15], seen) << near_m;
  }
}

TEST(HashCommand, RefusesInASentence) {
  const std::pair<std::vector<std::string>, std::string> refusals[] = {
      {{"hash", "--only", "atlantis"}, "--only: found atlantis, expected city, gallery, court, robots"},
      {{"hash", "--data", "/nowhere/at/all"}, "--data: /nowhere/at/all is not a folder"},
      {{"hash", "--scale", "0"}, "--scale: found 0, expected 1 to 16"}};
  for (auto [arguments, sentence] : refusals) {
    arguments.insert(arguments.begin(), TENEBRA_BENCH);
    const auto result = testing::run_program(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
  }
}

TEST(HashCommand, NamesScenesThatAreNotThere) {
  const testing::TemporaryFolder folder;
  const auto result =
      testing::run_program({TENEBRA_BENCH, "hash", "--only", "robots", "--data", folder.path().string()});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("# robots is left out: robots/Robot.aff is not there.\n"), std::string::npos)
      << result.output;
}

}  // namespace
}  // namespace tenebra::bench
