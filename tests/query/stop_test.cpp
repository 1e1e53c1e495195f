// A call that is asked to stop ends soon, whatever it is doing. What passes until then is counted in this
// process's time on the processors, as a part of the whole call's, on one thread (several wait for each
// other, which takes time too): other programs and slow machines count for nothing.
#include <gtest/gtest.h>

#include <tenebra/queries.h>
#include <tenebra/threads.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <functional>
#include <limits>
#include <optional>
#include <thread>

#include "support/soup.h"

namespace tenebra {
namespace {

double processors_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

using Call = std::function<Expected<void>(const StopFlag*)>;

constexpr double soon =
    0.2;  // 0.4 of adaptive occlusion and 0.9 of hard shadows, while no tree looked at the flag

Expected<void> on_one_thread(const Call& call, const StopFlag* stop) {
  Expected<void> done;
  with_threads(1, [&] { done = call(stop); });
  return done;
}

/// Time from a request after `moment_ms` to the end; none: the call had ended by then.
std::optional<double> stop_ms(const Call& call, double moment_ms) {
  StopFlag stop;
  std::atomic<bool> over{false};
  const double begin = processors_ms();
  double asked = 0;
  std::thread asker([&] {
    while (!over && processors_ms() < begin + moment_ms)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    asked = processors_ms();
    stop.request();
  });
  const Expected<void> done = on_one_thread(call, &stop);
  const double ended = processors_ms();
  over = true;
  asker.join();
  if (done) return std::nullopt;
  EXPECT_TRUE(is_stop(done));
  return ended - asked;
}

/// Of stops at moments that are spread over the call, the longest: as a part of the call's whole time. Each
/// of the shortest of three: where other programs run, the one who asks may be interrupted as it does.
double longest_stop(const Call& call) {
  constexpr int moments = 10;
  double whole =
      std::numeric_limits<double>::infinity();  // the shortest of three: machines change their speed
  for (int i = 0; i < 3; ++i) {
    const double begin = processors_ms();
    EXPECT_TRUE(on_one_thread(call, nullptr).has_value());
    whole = std::min(whole, processors_ms() - begin);
  }
  double longest = 0;
  int stops = 0;
  for (int moment = 0; moment < moments; ++moment) {
    double least = whole;
    for (int tries = 0; tries < 3 && least > soon * whole; ++tries)
      if (const auto taken = stop_ms(call, whole * moment / moments))
        least = std::min(least, *taken), ++stops;
    if (stops > 0 && least < whole) longest = std::max(longest, least);
  }
  EXPECT_GT(stops, moments / 2);
  return longest / whole;
}

/// Triangles enough that their trees take long, and few points, so that the trees are most of the work.
struct ManyTriangles {
  testing::Random random{7};
  testing::Soup soup = testing::random_soup(random, 150'000, 0.05);
  Geometry geometry = std::move(*Geometry::create(soup.positions, soup.triangles));
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> on;
  ShadowLight light{.position = {0.2f, 3, 0.1f}};

  explicit ManyTriangles(std::size_t points) {
    for (std::uint32_t id = 0; on.size() < points; id += 97) {
      positions.push_back(
          (glm::dvec3(soup.corner(id, 0)) + glm::dvec3(soup.corner(id, 1)) + glm::dvec3(soup.corner(id, 2))) /
          3.0);
      on.push_back(id);
    }
  }
  QueryPoints points() const { return {.positions = positions, .triangles = on}; }
  Call hard() {
    return [this](const StopFlag* stop) {
      std::vector<std::uint8_t> mask(positions.size());
      return PointTracer().hard_mask(geometry, points(), light, {}, mask, stop);
    };
  }
  Call soft() {
    return [this](const StopFlag* stop) {
      std::vector<float> fraction(positions.size());
      const AreaLight area = make_rectangle_light(light.position, {0.5f, 0, 0}, {0, 0, 0.5f}).value();
      return PointTracer().soft_visibility(geometry, points(), area, {}, fraction, {}, stop);
    };
  }
  Call occlusion(AoMode mode) {
    return [this, mode](const StopFlag* stop) {
      std::vector<float> openness(positions.size());
      return PointTracer().ambient_occlusion(geometry, points(), {.mode = mode}, openness, stop);
    };
  }
};

TEST(Stop, HardShadowsEndSoon) {
  EXPECT_LT(longest_stop(ManyTriangles(300).hard()), soon);
}

TEST(Stop, AdaptiveOcclusionEndsSoon) {
  EXPECT_LT(longest_stop(ManyTriangles(300).occlusion(AoMode::adaptive)), soon);
}

TEST(Stop, OcclusionByRaysEndsSoon) {
  EXPECT_LT(longest_stop(ManyTriangles(300).occlusion(AoMode::rays)), soon);
}

// 0.16 to 0.33 while the samples of its own surface were laid out without a look.
TEST(Stop, OcclusionByFieldsEndsSoon) {
  EXPECT_LT(longest_stop(ManyTriangles(300).occlusion(AoMode::field)), 0.1);
}

// 0.5 while what stands before a group of points was made ready without a look.
TEST(Stop, SoftShadowsEndSoon) {
  EXPECT_LT(longest_stop(ManyTriangles(16).soft()), soon);
}

/// Calls `ask`, stopped after `ms`, then to the end.
void ask_twice(double ms, const Call& ask) {
  StopFlag stop;
  std::thread asker([&] {
    std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms));
    stop.request();
  });
  static_cast<void>(ask(&stop));  // wherever it was
  asker.join();
  EXPECT_TRUE(ask(nullptr).has_value());
}

TEST(Stop, TheNextCallAnswersAsIfNoneHadBeenStopped) {
  ManyTriangles many(300);
  std::vector<std::uint8_t> mask(300), expected_mask(300);
  std::vector<float> open(300), expected_open(300);
  const AoConfig config{.mode = AoMode::adaptive}, fields{.mode = AoMode::field};
  const AreaLight area = make_rectangle_light(many.light.position, {0.5f, 0, 0}, {0, 0, 0.5f}).value();
  const auto some = QueryPoints{.positions = std::span(many.positions).first(16),
                                .triangles = std::span(many.on).first(16)};
  std::vector<float> soft(16), expected_soft(16), by_fields(300), expected_by_fields(300);
  ASSERT_TRUE(PointTracer().ambient_occlusion(many.geometry, many.points(), fields, expected_by_fields));
  ASSERT_TRUE(PointTracer().soft_visibility(many.geometry, some, area, {}, expected_soft, {}));
  ASSERT_TRUE(PointTracer().hard_mask(many.geometry, many.points(), many.light, {}, expected_mask));
  ASSERT_TRUE(PointTracer().ambient_occlusion(many.geometry, many.points(), config, expected_open));
  for (const double ms : {0.0, 10.0, 20.0, 40.0}) {
    PointTracer tracer;
    ask_twice(ms, [&](const StopFlag* stop) {
      return tracer.hard_mask(many.geometry, many.points(), many.light, {}, mask, stop);
    });
    EXPECT_EQ(mask, expected_mask);
    ask_twice(2 * ms, [&](const StopFlag* stop) {
      return tracer.ambient_occlusion(many.geometry, many.points(), config, open, stop);
    });
    EXPECT_EQ(open, expected_open);
    ask_twice(6 * ms, [&](const StopFlag* stop) {
      return tracer.ambient_occlusion(many.geometry, many.points(), fields, by_fields, stop);
    });
    EXPECT_EQ(by_fields, expected_by_fields);
    ask_twice(2 * ms, [&](const StopFlag* stop) {
      return tracer.soft_visibility(many.geometry, some, area, {}, soft, {}, stop);
    });
    EXPECT_EQ(soft, expected_soft);
  }
}

}  // namespace
}  // namespace tenebra
