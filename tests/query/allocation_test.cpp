// What a call takes of memory once the first has made room: counted in place of the global operator new.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <tenebra/queries.h>
#include <tenebra/threads.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <new>
#include <utility>

#include "support/soup.h"

namespace {

struct Counted {
  std::atomic<std::size_t> calls{0}, bytes{0};
  std::atomic<std::size_t> failing{0};  ///< the call that fails; 0: none
};
Counted& counted() {
  static Counted one;
  return one;
}

void* counting(std::size_t size, std::size_t alignment) {
  Counted& to = counted();
  if (++to.calls == to.failing) throw std::bad_alloc();
  to.bytes += size;
  void* const memory = alignment <= alignof(std::max_align_t)
                           ? std::malloc(size == 0 ? 1 : size)
                           : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return counting(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counting(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace tenebra {
namespace {

struct Taken {
  std::size_t calls, bytes;
};

Taken taken_by(const std::function<void()>& body) {
  Counted& now = counted();
  now.calls = 0, now.bytes = 0;
  body();
  return {now.calls, now.bytes};
}

/// A room, and points on its triangles.
struct Asked {
  testing::Random random{11};
  testing::Soup soup;
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> on;
  std::vector<float> first, second;
  std::vector<std::uint8_t> mask;
  PointTracer tracer;

  explicit Asked(std::size_t count, int clutter = 8) : soup(testing::room(random, clutter)) {
    for (std::uint32_t i = 0; positions.size() < count; ++i) {
      const auto id = static_cast<std::uint32_t>(i % soup.triangles.size());
      const double v = (i * 37 % 101 + 0.5) / 102, w = (1 - v) * ((i * 53 % 97 + 0.5) / 98);
      positions.push_back((1 - v - w) * glm::dvec3(soup.corner(id, 0)) + v * glm::dvec3(soup.corner(id, 1)) +
                          w * glm::dvec3(soup.corner(id, 2)));
      on.push_back(id);
    }
    first.resize(count), second.resize(count), mask.resize(count);
  }
  QueryPoints points() const { return {.positions = positions, .triangles = on}; }
};

/// Of the third call, on one thread: which of several gets what is another each time.
Taken later_call(const std::function<Expected<void>()>& ask) {
  Taken taken{};
  with_threads(1, [&] {
    for (int call = 0; call < 3; ++call) taken = taken_by([&] { EXPECT_TRUE(ask().has_value()); });
  });
  return taken;
}

void expect_little(const Taken& taken) {
  EXPECT_LE(taken.calls, 20u);
  EXPECT_LE(taken.bytes, 2048u);
}

const ShadowLight lamp{.position = {0.2f, 0.9f, -0.3f}};
AreaLight panel() {
  return make_rectangle_light({0.1f, 0.9f, -0.2f}, {0.2f, 0, 0}, {0, 0, 0.2f}).value();
}

/// Asks, on one thread, with each allocation in turn failing (of many only some), and then again: what the
/// first call has left behind must not show.
void expect_whole_after_failures(
    const std::function<Expected<void>(PointTracer&, std::span<float> out)>& ask) {
  std::vector<float> expected(500), out(500);
  std::size_t failed = 0;
  with_threads(1, [&] {
    PointTracer first;
    ASSERT_TRUE(ask(first, expected));
    ASSERT_NE(*std::min_element(expected.begin(), expected.end()),
              *std::max_element(expected.begin(), expected.end()));
    for (std::size_t k = 1;; k += 1 + k / 128) {
      PointTracer tracer;
      bool done = false;
      counted().calls = 0, counted().failing = k;
      try {
        done = ask(tracer, out).has_value();
      } catch (const std::bad_alloc&) {
      }
      counted().failing = 0;
      if (done) break;
      ++failed;
      std::fill(out.begin(), out.end(), 7.0f);
      ASSERT_TRUE(ask(tracer, out)) << k;
      ASSERT_EQ(out, expected) << "after allocation " << k << " had failed";
    }
  });
  EXPECT_GT(failed, 30u);
}

TEST(Allocation, WhereOneFailsTheNextHardMaskIsWhole) {
  const Asked asked(500);
  const auto geometry = std::move(*Geometry::create(asked.soup.positions, asked.soup.triangles));
  std::vector<std::uint8_t> mask(500);
  expect_whole_after_failures([&](PointTracer& tracer, std::span<float> out) {
    auto done = tracer.hard_mask(geometry, asked.points(), lamp, {}, mask);
    if (done) std::copy(mask.begin(), mask.end(), out.begin());
    return done;
  });
}

TEST(Allocation, WhereOneFailsTheNextSoftShadowsAreWhole) {
  const Asked asked(500);
  const auto geometry = std::move(*Geometry::create(asked.soup.positions, asked.soup.triangles));
  for (const double error : {0.0, 1.0})
    expect_whole_after_failures([&](PointTracer& tracer, std::span<float> out) {
      return tracer.soft_visibility(geometry, asked.points(), panel(), {.error_255 = error}, out, {});
    });
}

TEST(Allocation, WhereOneFailsTheNextOcclusionIsWhole) {
  const Asked asked(500);
  const auto geometry = std::move(*Geometry::create(asked.soup.positions, asked.soup.triangles));
  for (const AoMode mode : {AoMode::field, AoMode::adaptive})
    expect_whole_after_failures([&](PointTracer& tracer, std::span<float> out) {
      return tracer.ambient_occlusion(geometry, asked.points(), {.mode = mode}, out);
    });
}

// What is left are small lists that grow with neither triangles nor points, but for a few bytes for each
// sixteen thousand of them.
TEST(Allocation, HardMasksTakeNoMemoryAfterTheFirstCall) {
  std::size_t triangles = 0;
  for (const auto& [count, clutter] : {std::pair<std::size_t, int>{2000, 8}, {100000, 8}, {2000, 16000}}) {
    SCOPED_TRACE(fmt::format("{} points, clutter {}", count, clutter));
    Asked asked(count, clutter);
    triangles = std::max(triangles, asked.soup.triangles.size());
    auto geometry = std::move(*Geometry::create(asked.soup.positions, asked.soup.triangles));
    const auto ask = [&] { return asked.tracer.hard_mask(geometry, asked.points(), lamp, {}, asked.mask); };
    std::vector<glm::vec3> here = asked.soup.positions, there = here;
    there.back().y += 1e-4f;
    const auto move_and_ask = [&] {
      std::swap(here, there);
      EXPECT_TRUE(geometry.move_vertices(here));
      return ask();
    };
    for (const Taken& taken : {later_call(ask), later_call(move_and_ask)}) {
      expect_little(taken);
    }
  }
  EXPECT_GT(triangles, 20000u);
}

/// Points and triangles: few, many points, many triangles.
const std::pair<std::size_t, int> sizes[] = {{2000, 8}, {60000, 8}, {2000, 4000}};

/// Makes Asked of each size and expects little of calls of `ask(asked, geometry)` on it.
void expect_little_of_later(const std::function<Expected<void>(Asked&, const Geometry&)>& ask) {
  for (const auto& [count, clutter] : sizes) {
    SCOPED_TRACE(fmt::format("{} points, clutter {}", count, clutter));
    Asked asked(count, clutter);
    const auto geometry = std::move(*Geometry::create(asked.soup.positions, asked.soup.triangles));
    expect_little(later_call([&] { return ask(asked, geometry); }));
  }
}

void expect_little_of_soft(const SoftShadowConfig& config) {
  const AreaLight area = panel();
  expect_little_of_later([&](Asked& asked, const Geometry& geometry) {
    return asked.tracer.soft_visibility(geometry, asked.points(), area, config, asked.first, asked.second);
  });
}

void expect_little_of_occlusion(AoMode mode) {
  expect_little_of_later([mode](Asked& asked, const Geometry& geometry) {
    return asked.tracer.ambient_occlusion(geometry, asked.points(), {.mode = mode}, asked.first);
  });
}

TEST(Allocation, SoftShadowsTakeNoMemoryAfterTheFirstCall) {
  expect_little_of_soft({});
}

TEST(Allocation, SoftShadowsByTrianglesTakeNoMemoryAfterTheFirstCall) {
  expect_little_of_soft({.grouping = SoftGrouping::triangle});
}

TEST(Allocation, SoftShadowsByErrorTakeNoMemoryAfterTheFirstCall) {
  expect_little_of_soft({.error_255 = 1});
}

TEST(Allocation, OcclusionByFieldsTakesNoMemoryAfterTheFirstCall) {
  expect_little_of_occlusion(AoMode::field);
}

TEST(Allocation, AdaptiveOcclusionTakesNoMemoryAfterTheFirstCall) {
  expect_little_of_occlusion(AoMode::adaptive);
}

TEST(Allocation, OcclusionByRaysTakesNoMemoryAfterTheFirstCall) {
  expect_little_of_occlusion(AoMode::rays);
}

}  // namespace
}  // namespace tenebra
