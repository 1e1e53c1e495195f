// Memory of fields and surface samples: within the bound that was asked for, and samples on disk are not made
// again.
#include <tenebra/ambient_occlusion.h>

#include "ao/cache/memory_budget.h"
#include "ao_case.h"

namespace tenebra {
namespace {

using namespace testing;

constexpr std::size_t megabyte = 1 << 20;
constexpr int small_width = 80, small_height = 60;

AoConfig fields(int memory_mb) {
  AoConfig config;
  config.mode = AoMode::field;
  config.distance_m = 1.2;
  config.positions = config.directions = 576;  // 0.35 MB
  config.memory_mb = memory_mb;
  return config;
}

/// Floors, each with a ball above it, far enough apart that a camera sees one pair at a time.
Scene pairs_scene(int count) {
  SceneMaker make;
  for (int i = 0; i < count; ++i) {
    const float size = 2 + 0.1f * static_cast<float>(i);  // no two alike
    const glm::dvec3 at(100.0 * i, 0, 0);
    make.move(make.add(quad_mesh({-size, 0, -size}, {0, 0, 2 * size}, {2 * size, 0, 0}), at), {0, 0.1, 0});
    make.move(make.add(ball_mesh(0.25 * size, 24), at + glm::dvec3(0, 0.3 * size, 0)), {0.1, 0, 0});
  }
  return make.scene;
}
AoView pair_view(const Scene& scene, int pair) {
  const glm::dvec3 at(100.0 * pair, 0, 0);
  return {scene, 0, pinhole(at + glm::dvec3(3, 3, 4), at, 0.5, small_width, small_height), small_width,
          small_height};
}

TEST(MemoryBudget, GrantsNoMoreThanItHas) {
  ao::MemoryBudget budget;
  budget.begin_frame(100);
  ao::MemoryShare first(budget), second(budget);
  EXPECT_TRUE(first.take(60));
  EXPECT_FALSE(second.take(41));
  EXPECT_TRUE(budget.refused());
  EXPECT_FALSE(second.take(SIZE_MAX)) << "sums do not wrap";
  EXPECT_TRUE(second.take(40));
  first = {};
  EXPECT_EQ(budget.used(), 40u);
  EXPECT_EQ(budget.peak(), 100u);
}

TEST(MemoryBudget, DropsOnlyAsMuchAsItMust) {
  ao::MemoryBudget budget;
  std::vector<ao::MemoryShare> held;
  budget.set_drop([&] {
    if (held.empty()) return false;
    held.erase(held.begin());
    return true;
  });
  budget.begin_frame(100);
  for (int i = 0; i < 5; ++i) {
    ao::MemoryShare share(budget);
    ASSERT_TRUE(share.take(20));
    held.push_back(std::move(share));
  }
  ao::MemoryShare more(budget);
  EXPECT_TRUE(more.take(30));
  EXPECT_EQ(held.size(), 3u);
  budget.begin_frame(35);
  EXPECT_EQ(held.size(), 0u) << "a smaller limit holds at once";
  EXPECT_EQ(budget.peak(), 100u);
}

/// 2 MB hold some pairs, not all five: what was used least recently goes, and the picture never changes.
TEST(AoMemory, StaysWithinItsLimitAndLeavesThePictureAlone) {
  constexpr int pairs = 5;
  const Scene scene = pairs_scene(pairs);
  AmbientOcclusion tight, roomy;
  std::uint64_t built = 0;
  for (const int pair : {0, 1, 2, 3, 4, 4, 0, 3}) {
    const AoView frame = pair_view(scene, pair);
    EXPECT_EQ(occlude(tight, scene, frame, fields(2)), occlude(roomy, scene, frame, fields(512))) << pair;
    EXPECT_LE(tight.stats().peak_bytes, 2 * megabyte);
    EXPECT_GE(tight.stats().peak_bytes, tight.stats().field_bytes + tight.stats().sample_bytes);
    built += tight.stats().fields_built;
  }
  EXPECT_GT(roomy.stats().peak_bytes, 2 * megabyte) << "there was something to give up";
  EXPECT_GT(built, pairs) << "and something that was given up was needed again";
  EXPECT_TRUE(tight.notes().empty()) << "each frame by itself has room";
}

/// A pair that every other frame needs stays, whatever comes and goes between.
TEST(AoMemory, WhatWasUsedLeastRecentlyGoesFirst) {
  const Scene scene = pairs_scene(5);
  AmbientOcclusion ao;
  occlude(ao, scene, pair_view(scene, 0), fields(2));
  for (const int pair : {1, 2, 3, 4}) {
    occlude(ao, scene, pair_view(scene, pair), fields(2));
    EXPECT_GT(ao.stats().fields_built, 0u);
    occlude(ao, scene, pair_view(scene, 0), fields(2));
    EXPECT_EQ(ao.stats().fields_built, 0u) << pair;
  }
  occlude(ao, scene, pair_view(scene, 1), fields(2));
  EXPECT_GT(ao.stats().fields_built, 0u) << "something did go";
}

/// Too small for one frame: rays answer, within the error, the same on any number of threads, and a note says
/// so.
TEST(AoMemory, TooLittleForAFrameIsAnsweredByRays) {
  SceneMaker make;
  make.add(quad_mesh({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}));
  make.add(quad_mesh({-4, 0, -4}, {0, 6, 0}, {0, 0, 8}));
  for (int i = 0; i < 4; ++i)
    make.move(make.add(ball_mesh(0.4 + 0.05 * i, 20), {-1.5 + i, 0.5, 0.5 * i}), {0, 0.1, 0});
  const AoView frame(make.scene, 0, pinhole({5, 4, 6}, {0, 0.5, 0}, 0.5, small_width, small_height),
                     small_width, small_height);
  AoConfig rays = fields(512);
  rays.mode = AoMode::rays;
  rays.rays = 1024;
  const auto truth = occlude(make.scene, frame, rays);
  AoConfig config = fields(1);
  config.rays = 256;
  AmbientOcclusion ao;
  const auto expected = occlude(ao, make.scene, frame, config);
  EXPECT_LT(compare(frame, expected, truth).rms_255, 3);
  EXPECT_LE(ao.stats().peak_bytes, megabyte);
  EXPECT_GT(ao.stats().peak_bytes, megabyte / 4) << "what there is is used";
  ASSERT_EQ(ao.notes().size(), 1u);
  EXPECT_NE(ao.notes()[0].find("no room within 1 MB"), std::string::npos) << ao.notes()[0];
  EXPECT_EQ(occlude(ao, make.scene, frame, config), expected);
  EXPECT_EQ(ao.notes().size(), 1u) << "once";
  for (const int threads : {1, 2, 5})
    with_threads(threads, [&] { EXPECT_EQ(occlude(make.scene, frame, config), expected) << threads; });
}

/// Cells are divided as long as there is room for them; beyond, rays answer their points.
TEST(AoMemory, CellsStopWhereTheRoomEnds) {
  Mesh sieve = quad_mesh({0, 0, 0}, {0, 0, 3}, {3, 0, 0});
  for (int j = 0; j < 15; ++j)
    for (int i = 0; i < 15; ++i)
      append(sieve, quad_mesh({0.2f * static_cast<float>(i), 0.02f, 0.2f * static_cast<float>(j)},
                              {0, 0, 0.1f}, {0.1f, 0, 0}));
  SceneMaker make;
  make.add(sieve);
  const AoView frame(make.scene, 0, pinhole({1.5, 1.5, 3.5}, {1.5, 0, 1.5}, 0.7, 200, 150), 200, 150);
  AoConfig config = fields(512);
  config.distance_m = 0.6;
  AmbientOcclusion roomy, tight;
  const auto expected = occlude(roomy, make.scene, frame, config);
  config.memory_mb = 1;
  const auto found = occlude(tight, make.scene, frame, config);
  EXPECT_GT(roomy.stats().peak_bytes, megabyte) << "there was something to do without";
  EXPECT_LE(tight.stats().peak_bytes, megabyte);
  EXPECT_LT(compare(frame, found, expected).rms_255, 3);
}

TEST(AoMemory, ALowerLimitHoldsFromTheNextFrameOn) {
  const Scene scene = pairs_scene(3);
  AmbientOcclusion ao;
  for (const int pair : {0, 1, 2}) occlude(ao, scene, pair_view(scene, pair), fields(512));
  EXPECT_GT(ao.stats().field_bytes + ao.stats().sample_bytes, megabyte);
  occlude(ao, scene, pair_view(scene, 2), fields(1));
  EXPECT_LE(ao.stats().field_bytes + ao.stats().sample_bytes, megabyte);
}

/// Two objects are two processes here: the second finds what the first has learnt.
TEST(AoCache, SamplesAreFoundAgainOnDisk) {
  const Scene scene = pairs_scene(1);
  const AoView frame = pair_view(scene, 0);
  const TemporaryFolder folder;
  AoConfig config = fields(512);
  config.cache = folder.path() / "cache";
  std::vector<float> expected;
  std::uint64_t cold = 0;
  {
    AmbientOcclusion first;
    expected = occlude(first, scene, frame, config);
    cold = first.stats().rays_cast;
  }
  AmbientOcclusion second;
  EXPECT_EQ(occlude(second, scene, frame, config), expected);
  const std::uint64_t warm = second.stats().rays_cast;
  EXPECT_LT(warm, cold);
  occlude(second, scene, frame, config);
  EXPECT_EQ(second.stats().rays_cast, warm) << "the first frame casts no ray that later ones do not";
  EXPECT_TRUE(second.notes().empty());
  for (const auto& file : std::filesystem::directory_iterator(config.cache))
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  AmbientOcclusion third;
  EXPECT_EQ(occlude(third, scene, frame, config), expected) << "what is damaged is made anew";
  EXPECT_EQ(third.stats().rays_cast, cold);
  EXPECT_EQ(third.notes().size(), 3u) << "and named: two bodies, one field";
}

/// What must go for want of room is kept on disk, and read again.
TEST(AoCache, WhatIsDroppedIsKeptOnDisk) {
  const Scene scene = pairs_scene(4);
  const TemporaryFolder folder;
  AoConfig config = fields(2);
  config.cache = folder.path();
  AmbientOcclusion ao;
  const AoView frame = pair_view(scene, 0);
  const auto before = occlude(ao, scene, frame, config);
  for (const int pair : {1, 2, 3}) occlude(ao, scene, pair_view(scene, pair), config);
  const auto again = occlude(ao, scene, frame, config);
  EXPECT_EQ(again, before);
  EXPECT_EQ(ao.stats().fields_built, 0u);
  const std::uint64_t rays = ao.stats().rays_cast;
  EXPECT_EQ(occlude(ao, scene, frame, config), again);
  EXPECT_EQ(ao.stats().rays_cast, rays) << "no sample was cast again";
  EXPECT_LE(ao.stats().peak_bytes, 2 * megabyte);
}

}  // namespace
}  // namespace tenebra
