// What a call takes of memory once the first has made room: counted in place of the global operator new.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <tenebra/queries.h>
#include <tenebra/threads.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
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

const ShadowLight lamp{.position = {0.2f, 0.9f, -0.3f}};

TEST(Allocation, WhereOneFailsTheNextCallFindsEverythingAnew) {
  Asked asked(500);
  auto geometry = std::move(*Geometry::create(asked.soup.positions, asked.soup.triangles));
  std::vector<std::uint8_t> expected(500), mask(500);
  const auto ask = [&](PointTracer& tracer, std::vector<std::uint8_t>& out) {
    std::fill(out.begin(), out.end(), std::uint8_t{7});
    return tracer.hard_mask(geometry, asked.points(), lamp, {}, out).has_value();
  };
  std::size_t failed = 0;
  with_threads(1, [&] {
    ASSERT_TRUE(ask(asked.tracer, expected));
    ASSERT_GT(std::count(expected.begin(), expected.end(), 0), 0);
    for (std::size_t k = 1;; ++k) {
      PointTracer tracer;
      bool done = false;
      counted().calls = 0, counted().failing = k;
      try {
        done = tracer.hard_mask(geometry, asked.points(), lamp, {}, mask).has_value();
      } catch (const std::bad_alloc&) {
      }
      counted().failing = 0;
      if (done) break;
      ++failed;
      ASSERT_TRUE(ask(tracer, mask)) << k;
      ASSERT_EQ(mask, expected) << "after allocation " << k << " had failed";
    }
  });
  EXPECT_GT(failed, 30u);
}

// What is left are closures of parallel loops and one small list: none grows with triangles, and none is made
// for each point.
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
      EXPECT_LE(taken.calls, 100u);
      EXPECT_LE(taken.bytes, 8192u);
    }
  }
  EXPECT_GT(triangles, 20000u);
}

// Soft shadows make their groups anew, and ambient occlusion its samples of a picture: some bytes a point,
// and the same in each call, so that nothing grows.
TEST(Allocation, OtherCallsTakeTheSameEachTime) {
  Asked asked(20000);
  const auto geometry = std::move(*Geometry::create(asked.soup.positions, asked.soup.triangles));
  const AreaLight area = make_rectangle_light({0.1f, 0.9f, -0.2f}, {0.2f, 0, 0}, {0, 0, 0.2f}).value();
  const std::pair<const char*, std::function<Expected<void>()>> calls[] = {
      {"soft",
       [&] {
         return asked.tracer.soft_visibility(geometry, asked.points(), area, {}, asked.first, asked.second);
       }},
      {"adaptive",
       [&] {
         return asked.tracer.ambient_occlusion(geometry, asked.points(), {.mode = AoMode::adaptive},
                                               asked.first);
       }},
      {"field", [&] {
         return asked.tracer.ambient_occlusion(geometry, asked.points(), {.mode = AoMode::field},
                                               asked.first);
       }}};
  for (const auto& [name, ask] : calls) {
    const Taken third = later_call(ask), sixth = later_call(ask);
    EXPECT_LE(sixth.bytes, third.bytes + third.bytes / 16) << name;
    EXPECT_LE(sixth.bytes, 200 * asked.positions.size()) << name;
    std::printf("%-8s %zu allocations, %zu bytes a call of %zu points\n", name, sixth.calls, sixth.bytes,
                asked.positions.size());
  }
}

}  // namespace
}  // namespace tenebra
