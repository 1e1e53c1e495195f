// Surface samples on disk: what was saved comes back bit for bit, whoever saved it; whatever else lies there
// is refused with a sentence, at once.
#include "ao/surface/sample_file.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <set>

#include "base/sort_unique.h"
#include "standing_body.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using namespace testing;
namespace fs = std::filesystem;

const ao::RayKernels kernels = ao::ray_kernels(SimdLevel::automatic);
constexpr double reach = 0.8;

/// A floor under a plate with holes, and a ball of small triangles: all kinds of samples.
Mesh plate_and_ball() {
  Mesh mesh = quad_mesh({0, 0, 0}, {0, 0, 2}, {2, 0, 0});
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i)
      append(mesh, quad_mesh({0.3f * static_cast<float>(i), 0.02f, 0.3f * static_cast<float>(j)},
                             {0, 0, 0.15f}, {0.15f, 0, 0}));
  append(mesh, ball_mesh(0.3, 30));
  return mesh;
}

struct Body : StandingBody {
  Body() : StandingBody(plate_and_ball()) {}
  ao::CacheKey key() const { return ao::sample_key(shape, reach); }
};

std::vector<ao::SurfacePoint> points_of(const Body& body, std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<ao::SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    const double v = random.unit(), w = random.unit() * (1 - v);
    const auto triangles = static_cast<std::uint32_t>(body.shape.triangles.size());
    points.push_back({random.index(random.chance(0.5) ? 2 : triangles), static_cast<float>(v),
                      static_cast<float>(w), random.chance(0.8)});
  }
  return points;
}

/// Asks and fills until nothing is missing; returns the answers.
std::vector<float> fill(ao::SelfOcclusion& samples, const std::vector<ao::SurfacePoint>& points) {
  std::vector<float> answers;
  for (int round = 0; round < 8; ++round) {
    std::vector<std::uint64_t> missing;
    answers.clear();
    for (const ao::SurfacePoint& point : points) {
      const auto answer = samples.find(point, missing);
      answers.push_back(answer.state == ao::SelfOcclusion::State::mixed ? samples.look(point, kernels)
                                                                        : answer.occlusion);
    }
    if (missing.empty()) return answers;
    base::sort_unique(missing);
    EXPECT_TRUE(samples.fill(missing, kernels, {}, nullptr));
  }
  ADD_FAILURE() << "still missing";
  return {};
}

Expected<void> save(const fs::path& folder, const Body& body, const ao::SelfOcclusion& samples) {
  return ao::save_samples(folder, body.key(), samples.samples(), samples.layout_samples());
}
Expected<void> load(const fs::path& folder, const Body& body, ao::SelfOcclusion& samples) {
  const auto found = ao::load_samples(folder, body.key(), samples.layout_samples());
  if (!found) return tl::unexpected(found.error());
  samples.learn(*found);
  return {};
}

TEST(SampleFile, GivesBackWhatWasSavedBitForBit) {
  const TemporaryFolder folder;
  const Body body;
  ao::SelfOcclusion computed(body.shape, body.casters, reach), loaded(body.shape, body.casters, reach);
  computed.lay(), loaded.lay();
  const auto points = points_of(body, 1, 1500);
  const std::vector<float> expected = fill(computed, points);
  EXPECT_GT(computed.cells(), 20u);
  ASSERT_TRUE(save(folder.path() / "new" / "folder", body, computed));
  ASSERT_TRUE(load(folder.path() / "new" / "folder", body, loaded));
  EXPECT_EQ(fill(loaded, points), expected);
  EXPECT_EQ(loaded.filled(), 0u) << "no rays were cast for what the file holds";
  const auto others = points_of(body, 2, 300);
  EXPECT_EQ(fill(loaded, others), fill(computed, others)) << "and what is new fits in";
}

TEST(SampleFile, JoinsWhatProcessesKnow) {
  const TemporaryFolder folder;
  const Body body;
  const auto first = points_of(body, 3, 400), second = points_of(body, 4, 400);
  ao::SelfOcclusion one(body.shape, body.casters, reach), other(body.shape, body.casters, reach),
      both(body.shape, body.casters, reach);
  one.lay(), other.lay(), both.lay();
  const auto expected_first = fill(one, first), expected_second = fill(other, second);
  ASSERT_TRUE(save(folder.path(), body, one));
  ASSERT_TRUE(save(folder.path(), body, other));
  ASSERT_TRUE(load(folder.path(), body, both));
  EXPECT_EQ(fill(both, first), expected_first);
  EXPECT_EQ(fill(both, second), expected_second);
  EXPECT_EQ(both.filled(), 0u);
}

TEST(SampleFile, TheKeyChangesWithEverythingThatMatters) {
  const Body body;
  std::set<std::string> keys;
  const auto add = [&](const ao::ObjectShape& shape, double length) {
    keys.insert(ao::sample_path("", ao::sample_key(shape, length)).string());
  };
  add(body.shape, reach);
  add(body.shape, std::nextafter(reach, 1));
  ao::ObjectShape other = body.shape;
  other.positions[3].y = 1e-30f;
  add(other, reach);
  other = body.shape;
  other.normals[5].x = 0.5f;
  add(other, reach);
  other = body.shape;
  std::swap(other.triangles[0].x, other.triangles[0].y);
  add(other, reach);
  other = body.shape;
  other.casts[2] = 0;
  add(other, reach);
  EXPECT_EQ(keys.size(), 6u);
  EXPECT_EQ(body.key(), Body().key());
}

TEST(SampleFile, RefusesWhatIsDamagedCutOrForeign) {
  const TemporaryFolder folder;
  const Body body;
  ao::SelfOcclusion samples(body.shape, body.casters, reach);
  samples.lay();
  const std::size_t count = samples.layout_samples();
  const fs::path path = ao::sample_path(folder.path(), body.key());
  EXPECT_FALSE(ao::load_samples(folder.path(), body.key(), count)) << "missing";
  fill(samples, points_of(body, 5, 100));
  ASSERT_TRUE(save(folder.path(), body, samples));
  const std::string good = read_text(path);
  const auto refused = [&](const std::string& bytes) {
    write_text(path, bytes);
    const auto loaded = ao::load_samples(folder.path(), body.key(), count);
    if (loaded) return bytes == good;
    EXPECT_NE(loaded.error().message.find(path.string()), std::string::npos);
    EXPECT_EQ(loaded.error().message.find('\n'), std::string::npos);
    return true;
  };
  for (std::size_t size = 0; size < good.size(); size += size < 100 ? 1 : 97)
    EXPECT_TRUE(refused(good.substr(0, size)));
  EXPECT_TRUE(refused(good + "x"));
  for (std::size_t at = 0; at < 100; ++at) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 1 << at % 8);
    EXPECT_TRUE(refused(bytes)) << at;
  }
  write_text(path, good);
  EXPECT_TRUE(ao::load_samples(folder.path(), body.key(), count));
  EXPECT_FALSE(ao::load_samples(folder.path(), body.key(), count / 2)) << "of another layout";
  EXPECT_FALSE(ao::load_samples(folder.path(), ao::sample_key(body.shape, 2 * reach), count));
}

TEST(SampleFile, WhatIsDroppedHoldsNoMemoryAndIsReadAgain) {
  const TemporaryFolder folder;
  const Body body;
  ao::MemoryBudget budget;
  ao::SelfOcclusion samples(body.shape, body.casters, reach, ao::SelfOcclusion::most_cells, &budget);
  ASSERT_TRUE(samples.lay());
  const auto points = points_of(body, 3, 800);
  const std::vector<float> expected = fill(samples, points);
  ASSERT_GT(samples.cells(), 10u);
  EXPECT_GT(samples.held_bytes(), 0u);
  EXPECT_LE(samples.held_bytes(), samples.bytes()) << "no more than was asked for";
  EXPECT_EQ(samples.bytes(), budget.used());
  const std::uint64_t known = samples.known();
  ASSERT_TRUE(save(folder.path(), body, samples));
  samples.drop();
  EXPECT_EQ(samples.held_bytes(), 0u);
  EXPECT_EQ(budget.used(), 0u);
  ASSERT_TRUE(samples.lay());
  ASSERT_TRUE(load(folder.path(), body, samples));
  EXPECT_EQ(samples.known(), known);
  EXPECT_EQ(fill(samples, points), expected);
}

TEST(SampleFile, CellsOfOthersThatHaveNoRoomAreNothingToTell) {
  const Body body;
  ao::SelfOcclusion others(body.shape, body.casters, reach);
  others.lay();
  const auto points = points_of(body, 3, 800);
  fill(others, points);
  ASSERT_GT(others.cells(), 10u);
  ao::MemoryBudget budget;
  ao::SelfOcclusion samples(body.shape, body.casters, reach, ao::SelfOcclusion::most_cells, &budget);
  ASSERT_TRUE(samples.lay());
  budget.begin_frame(budget.used());
  samples.learn(others.samples());
  EXPECT_EQ(samples.cells(), 0u);
  EXPECT_FALSE(budget.refused()) << "nothing that the frame needs";
  fill(samples, points);
  EXPECT_TRUE(budget.refused()) << "now cells are needed";
}

/// Whole in its bytes, but with lists that do not fit a layout.
TEST(SampleFile, RefusesListsThatDoNotFit) {
  const TemporaryFolder folder;
  const ao::CacheKey key{1, 2};
  using Run = ao::SurfaceSamples::Run;
  for (const std::vector<Run>& runs : {std::vector<Run>{{6, 3}},
                                       {{0, 2}, {1, 1}},
                                       {{4, 1}, {0, 2}},
                                       {{0, 2}},
                                       {{0, 0xffffffffu}},
                                       {{0xffffffffu, 3}}}) {
    ao::SurfaceSamples samples;
    samples.runs = runs;
    samples.values = {1, 2, 3};
    ASSERT_TRUE(ao::save_samples(folder.path(), key, samples, 8));
    EXPECT_FALSE(ao::load_samples(folder.path(), key, 8));
    fs::remove(ao::sample_path(folder.path(), key));
  }
}

TEST(SampleFile, DoesNotWaitForPipesAndFoldersInTheWay) {
  const TemporaryFolder folder;
  const Body body;
  ao::SelfOcclusion samples(body.shape, body.casters, reach);
  samples.lay();
  const fs::path path = ao::sample_path(folder.path(), body.key());
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_FALSE(load(folder.path(), body, samples));
  EXPECT_FALSE(save(folder.path(), body, samples));
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_FALSE(load(folder.path(), body, samples));
  EXPECT_FALSE(save(folder.path(), body, samples));
}

TEST(SampleFile, RefusesKeysThatAreNoKeys) {
  const TemporaryFolder folder;
  const ao::CacheKey key{1, 2};
  constexpr std::size_t each = ao::SurfaceLayout::cell_samples;
  for (const auto& [cells, good] : {std::pair{std::vector<std::uint64_t>{7, 5, 6}, true},
                                    {{5, 6, std::uint64_t{1} << 63}, false},
                                    {{~std::uint64_t{0}}, false},
                                    {{5, 6, 5}, false}}) {
    ao::SurfaceSamples samples;
    samples.cells = cells;
    samples.cell_values.assign(cells.size() * each, 3);
    ASSERT_TRUE(ao::save_samples(folder.path(), key, samples, 8));
    EXPECT_EQ(ao::load_samples(folder.path(), key, 8).has_value(), good);
    fs::remove(ao::sample_path(folder.path(), key));
  }
}

/// Four processes write to one folder at once: whoever reads finds nothing or the truth.
TEST(SampleFile, ProcessesMayShareAFolder) {
  const TemporaryFolder folder;
  const Body body;
  std::vector<ao::SurfaceSamples> known;
  std::size_t count = 0;
  for (std::uint64_t seed = 10; seed < 14; ++seed) {
    ao::SelfOcclusion samples(body.shape, body.casters, reach);
    samples.lay();
    fill(samples, points_of(body, seed, 60));
    known.push_back(samples.samples());
    count = samples.layout_samples();
  }
  std::vector<pid_t> writers;
  for (const ao::SurfaceSamples& samples : known) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      bool good = true;
      for (int i = 0; i < 20; ++i) good &= bool(ao::save_samples(folder.path(), body.key(), samples, count));
      ::_exit(good ? 0 : 1);
    }
    writers.push_back(child);
  }
  for (const pid_t writer : writers) {
    int status = 1;
    for (bool runs = true; runs;) {
      runs = ::waitpid(writer, &status, WNOHANG) == 0;
      const bool there = ao::cache_file_exists(ao::sample_path(folder.path(), body.key()));
      const auto found = ao::load_samples(folder.path(), body.key(), count);
      if (!found && there) ADD_FAILURE() << found.error().message;
    }
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(folder.names().size(), 1u) << "no temporary files are left";
}

}  // namespace
}  // namespace tenebra
