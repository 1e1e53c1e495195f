// The caller's floating-point settings: neither do they reach the results, nor do they get lost. Rounding
// upwards, flushing results to zero and taking denormals as zero, each on any number of threads.
#ifdef __SSE__  // the settings that it makes are MXCSR's
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>

#include <tenebra/hard_shadows.h>
#include "parallel/parallel.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

constexpr unsigned to_nearest = 0x1f80, round_up = 0x5f80, flush_and_daz = 0x9fc0, all_of_them = 0xdfc0;
constexpr unsigned flags = 0x3f;  // exceptions seen so far, no setting

class CallerSettings {
public:
  explicit CallerSettings(unsigned settings) : before_(_mm_getcsr()) { _mm_setcsr(settings); }
  ~CallerSettings() { _mm_setcsr(before_); }
  CallerSettings(const CallerSettings&) = delete;
  CallerSettings& operator=(const CallerSettings&) = delete;

private:
  unsigned before_;
};

// 300 triangles, each pixel sees one of them at random; 2^exponent is the unit.
struct Shot {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> ids;
  ViewRays view;
  ShadowLight light;
  static constexpr int width = 97, height = 61;

  explicit Shot(int exponent) {
    const float unit = std::ldexp(1.0f, exponent);
    testing::Random random(5);
    for (std::uint32_t i = 0; i < 900; i += 3) {
      const glm::vec3 centre = random.in_cube(1);
      for (int k = 0; k < 3; ++k) positions.push_back((centre + glm::vec3(random.in_cube(0.1))) * unit);
      triangles.push_back({i, i + 1, i + 2});
    }
    for (int i = 0; i < width * height; ++i) ids.push_back(random.index(300));
    view = {.eye = glm::vec3(0.3f, 0.2f, 5) * unit,
            .d0 = glm::vec3(-1, 1, -5) * unit,
            .dx = glm::vec3(0.02f, 0, 0) * unit,
            .dy = glm::vec3(0, -0.03f, 0) * unit};
    light.position = glm::vec3(2, 4, 3) * unit;
  }

  struct Result {
    std::vector<glm::dvec3> points;
    ShadowMask mask;
    bool operator==(const Result&) const = default;
  };
  Result result() const {
    VisiblePoints points;
    compute_visible_points(ids, width, height, view, {positions, triangles, {}}, points);
    const unsigned after_points = _mm_getcsr();
    ShadowMask mask;
    ShadowTracer().trace_shadow_mask(testing::seen_from(points, view), {positions, triangles, {}}, light, {},
                                     mask);
    EXPECT_EQ(_mm_getcsr() & ~flags, after_points & ~flags);
    return {points.positions, mask};
  }
};

class FloatSettings : public ::testing::TestWithParam<int> {};

TEST_P(FloatSettings, OfTheCallerChangeNoBitAndComeBack) {
  const Shot shot(GetParam());
  const Shot::Result expected = shot.result();
  ASSERT_GT(std::count(expected.mask.begin(), expected.mask.end(), 255), 20);
  ASSERT_GT(std::count(expected.mask.begin(), expected.mask.end(), 0), 20);
  for (const unsigned settings : {to_nearest, round_up, flush_and_daz, all_of_them}) {
    for (const int threads : {0, 1, 4}) {
      Shot::Result found;
      unsigned after = 0;
      {
        const CallerSettings caller(settings);
        with_threads(threads, [&] { found = shot.result(); });
        after = _mm_getcsr() & ~flags;
      }
      EXPECT_EQ(after, settings) << threads << " threads";
      EXPECT_EQ(found.points == expected.points, true) << std::hex << settings << ", threads " << threads;
      EXPECT_EQ(found.mask == expected.mask, true) << std::hex << settings << ", threads " << threads;
    }
  }
}

// At 2^-128 most coordinates are denormal floats.
INSTANTIATE_TEST_SUITE_P(Units, FloatSettings, ::testing::Values(0, -128),
                         [](const auto& info) { return info.param == 0 ? "metre" : "denormal"; });

TEST(FloatEnvironment, HoldsIeeeDefaultsAndGivesTheCallersBack) {
  const CallerSettings caller(all_of_them);
  {
    const parallel::FloatEnvironment ieee;
    EXPECT_EQ(_mm_getcsr() & ~flags, to_nearest);
  }
  EXPECT_EQ(_mm_getcsr() & ~flags, all_of_them);
}

TEST(FloatEnvironment, EveryLoopBodyHasIeeeDefaults) {
  const CallerSettings caller(all_of_them);
  for (const int threads : {0, 1, 4}) {
    std::vector<unsigned> seen(1000, 0);
    with_threads(threads, [&] {
      parallel::parallel_ranges(seen.size(), 1,
                                [&](std::size_t first, std::size_t) { seen[first] = _mm_getcsr() & ~flags; });
    });
    EXPECT_EQ(std::count(seen.begin(), seen.end(), to_nearest), 1000) << threads;
    seen.assign(seen.size(), 0);
    with_threads(threads, [&] {
      parallel::parallel_tasks(1000,
                               [&](int i) { seen[static_cast<std::size_t>(i)] = _mm_getcsr() & ~flags; });
    });
    EXPECT_EQ(std::count(seen.begin(), seen.end(), to_nearest), 1000) << threads;
  }
  EXPECT_EQ(_mm_getcsr() & ~flags, all_of_them);
}

}  // namespace
}  // namespace tenebra
#endif
