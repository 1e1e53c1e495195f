// Masks of directional lights and of lights at any distance: exact, the same for threads and instruction
// sets, and how much work they take.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "shadow/distant_lights.h"
#include "shadow/mask_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using glm::vec3;

/// Soups under directional light: along axes, nearly so, in the planes of triangles, along edges.
ShadowLight sun_of_kind(int kind, const Soup& soup, Random& random) {
  const auto id = random.index(static_cast<std::uint32_t>(soup.triangles.size()));
  const dvec3 a(soup.corner(id, 0)), b(soup.corner(id, 1)), c(soup.corner(id, 2));
  dvec3 to_light = direction_of_kind(kind, random);
  if (kind == 3) to_light = (b - a) + random.in(-1, 1) * (c - a);  // edge-on, but for rounding
  if (kind == 4) to_light = b - a;
  if (to_light == dvec3(0)) to_light = {0, 1, 0};
  const double largest = std::max({std::abs(to_light.x), std::abs(to_light.y), std::abs(to_light.z)});
  return sun(to_light / largest * std::pow(10.0, random.in(-30, 30)));
}

TEST(ShadowMaskSun, IsExactOnEverySoup) {
  Shares shares;
  std::uint64_t seed = 7000;
  for (const SoupMaker& maker : soup_makers())
    for (int kind = 0; kind < 5; ++kind) {
      ++seed;
      Random random(seed);
      MaskCase c;
      const double scale = seed % 4 == 0 ? 0x1p-60 : seed % 4 == 1 ? 0x1p40 : 1;
      const dvec3 offset = seed % 4 == 2 ? dvec3(1e6, -2e6, 1e6) : dvec3(0);
      c.name = fmt::format("{}, sun kind {}, seed {}", maker.name, kind, seed);
      c.soup = maker.make(random).moved(scale, offset);
      c.light = sun_of_kind(kind, c.soup, random);
      c.config.simd = simd_levels[seed % std::size(simd_levels)];
      if (!simd_level_supported(c.config.simd)) c.config.simd = SimdLevel::automatic;
      c.view = view_from_light(c.light);
      c.points = points_on_triangles(c.soup, random, 3000);
      EXPECT_TRUE(exact(c, &shares));
      if (kind < 2) {
        c.points = points_behind_edges(c.soup, c.light, random, 1500);
        EXPECT_TRUE(exact(c, &shares));
      }
    }
  shares.print("soups under the sun");
  EXPECT_GT(shares.double_unknown, 100u) << "the adversary is too kind";
}

/// The room's light, moved away by `distance`.
MaskCase far_case(double distance, int kind, std::uint64_t seed, int size) {
  Random random(seed);
  MaskCase c;
  c.soup = room(random, 600);
  const dvec3 direction = kind == 0 ? dvec3(1, 0, 0) : glm::normalize(dvec3(0.3, 1, 0.2));
  c.light = point_light(dvec3(0.2, 1.6, -0.3) + distance * direction);
  c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, size, size);
  c.points = view_samples(c.soup.view(), c.view, size, size);
  c.name = fmt::format("room, light moved by {} ({}), seed {}", distance, kind, seed);
  return c;
}

TEST(ShadowMaskFarLight, IsExactAtPowersOfTen) {
  for (const int kind : {0, 1}) {
    for (int power = -18; power <= 18; power += 3) {
      const MaskCase c = far_case(std::pow(10.0, power), kind, 81, 96);
      EXPECT_TRUE(exact(c));
    }
    EXPECT_TRUE(exact(far_case(3e38, kind, 81, 96)));
  }
  for (int corner = 0; corner < 8; ++corner) {
    MaskCase c = far_case(1, 1, 82, 96);
    constexpr float far = std::numeric_limits<float>::max();
    c.light.position = {corner & 1 ? far : -far, corner & 2 ? far : -far, corner & 4 ? far : -far};
    c.name = fmt::format("corner {} of the float range", corner);
    EXPECT_TRUE(exact(c));
  }
}

TEST(ShadowMaskFarLight, IsExactOnEverySoup) {
  Shares shares;
  std::uint64_t seed = 7500;
  for (const SoupMaker& maker : soup_makers())
    for (const double distance : {30.0, 1e4, 1e9, 1e15}) {
      ++seed;
      Random random(seed);
      MaskCase c;
      c.name = fmt::format("{}, light {} extents away, seed {}", maker.name, distance, seed);
      c.soup = maker.make(random);
      const dvec3 low = c.soup.low(), size = c.soup.high() - low;
      c.light =
          point_light(low + 0.5 * size +
                      distance * glm::length(size) * direction_of_kind(static_cast<int>(seed % 3), random));
      c.config.simd = simd_levels[seed % std::size(simd_levels)];
      if (!simd_level_supported(c.config.simd)) c.config.simd = SimdLevel::automatic;
      c.view = view_from_light(c.light);
      c.points = points_on_triangles(c.soup, random, 2000);
      EXPECT_TRUE(exact(c, &shares));
      c.points = points_behind_edges(c.soup, c.light, random, 1000);
      EXPECT_TRUE(exact(c, &shares));
    }
  shares.print("soups under far lights");
}

// A lamp's own triangles around a light that is far from all points: near the light, and behind it.
TEST(ShadowMaskFarLight, IsExactAmongTrianglesAtTheLight) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Random random(seed);
    MaskCase c;
    const Soup seen = room(random, 100);
    c.soup = seen;
    const dvec3 at = 200.0 * random.direction();
    c.light = point_light(at);
    c.soup.append(random_soup(random, 200, 0.5).moved(1, at));
    c.soup.append(random_soup(random, 100, 0.3).moved(1000, dvec3(0)));
    c.view = view_from_light(c.light);
    c.points = points_on_triangles(seen, random, 3000);
    c.name = fmt::format("triangles at the light, seed {}", seed);
    EXPECT_TRUE(exact(c));
  }
}

// Against the same light 100 m away: which no bound that follows the distance would keep up with.
TEST(ShadowMaskFarLight, TakesNoMoreThanANearOne) {
  ShadowTracer tracer;
  traced(far_case(100, 1, 83, 160), tracer);
  const TraceStats near = tracer.stats();
  for (const double distance : {1e3, 1e6, 1e9, 1e12, 1e15, 1e18, 3e38}) {
    traced(far_case(distance, 1, 83, 160), tracer);
    const TraceStats& far = tracer.stats();
    EXPECT_EQ(tracer.ran(), Variant::tiles) << distance;
    EXPECT_LE(far.nodes, 2 * near.nodes) << distance;
    EXPECT_LE(far.leaf_tests, 2 * near.leaf_tests) << distance;
    EXPECT_LE(far.float_unknown, near.float_unknown + far.rays / 100) << distance;
    EXPECT_LE(far.double_unknown, near.double_unknown + far.rays / 1000) << distance;
  }
}

// Far along an axis, all walls and floors along it are lit at 10^-18 radians: many pairs are truly close, and
// all coplanar triangles before a point come near its ray. A few a ray all the same.
TEST(ShadowMaskFarLight, GrazesWithAFewCloseCallsARay) {
  ShadowTracer tracer;
  for (const double distance : {1e3, 1e6, 1e9, 1e12, 1e15, 1e18, 3e38}) {
    traced(far_case(distance, 0, 83, 160), tracer);
    const TraceStats& far = tracer.stats();
    EXPECT_EQ(tracer.ran(), Variant::tiles) << distance;
    EXPECT_LE(far.leaf_tests, 4 * far.rays) << distance;
    EXPECT_LE(far.double_unknown, 2 * far.rays) << distance;
  }
}

// Its cone and its range end amid the room; points with and without rows of positions.
TEST(ShadowMaskFarLight, KeepsItsConeAndRange) {
  for (const double distance : {100.0, 1e4, 1e6}) {
    MaskCase c = far_case(distance, 1, 88, 120);
    const dvec3 from(c.light.position);
    c.light.spot_axis = vec3(glm::normalize(dvec3(0.5, 0.1, 0.3) - from));
    c.light.spot_cos_outer = static_cast<float>(std::cos(0.8 / distance));
    c.name = fmt::format("spot {} m away, seed 88", distance);
    for (const float range_m : {0.0f, static_cast<float>(glm::length(from))}) {
      c.light.range_m = range_m;
      c.points = view_samples(c.soup.view(), c.view, 120, 120);
      const ShadowMask expected = oracle(c);
      EXPECT_TRUE(same_mask(c, traced(c), expected)) << range_m;
      const std::vector<std::uint32_t> ids = c.points.triangles;
      compute_visible_points(ids, 120, 120, c.view, c.soup.view(), c.points, PointLayout::tiles);
      ShadowTracer tracer;
      const ShadowMask mask = traced(c, tracer);
      EXPECT_EQ(tracer.ran(), Variant::tiles);
      EXPECT_EQ(differences(mask, expected).size(), 0u) << distance << " " << range_m;
    }
  }
}

TEST(ShadowMaskSun, IsTracedByTiles) {
  MaskCase c = far_case(0, 0, 84, 64);
  c.light = sun({0.3, 1, 0.2});
  ShadowTracer tracer;
  EXPECT_TRUE(same_mask(c, traced(c, tracer), oracle(c)));
  EXPECT_EQ(tracer.ran(), Variant::tiles);
  EXPECT_EQ(tracer.stats().lights_tiles, 1u);
  EXPECT_EQ(tracer.stats().lights_cones, 0u);
  const ShadowMask expected = oracle(c);
  const std::vector<std::uint32_t> ids = c.points.triangles;
  compute_visible_points(ids, 64, 64, c.view, c.soup.view(), c.points, PointLayout::tiles);
  ASSERT_TRUE(c.points.positions.empty());
  EXPECT_EQ(differences(traced(c, tracer), expected).size(), 0u);
  c.config.variant = Variant::spheres;
  traced(c, tracer);
  EXPECT_EQ(tracer.ran(), Variant::spheres);
  EXPECT_EQ(tracer.stats().lights_tiles, 0u);
  EXPECT_EQ(tracer.stats().lights_cones, 1u);
}

TEST(ShadowMaskSun, IsTheSameForThreadsAndInstructionSets) {
  MaskCase c = far_case(0, 0, 85, 200);
  for (const dvec3 direction : {dvec3(0.3, 1, 0.2), dvec3(-1, 0.01, 0), dvec3(0, 1, 0)}) {
    c.light = sun(direction);
    const ShadowMask expected = oracle(c);
    expect_same_at_levels_and_threads(c, expected);
    c.config.variant = Variant::precise_sorted;
    EXPECT_TRUE(same_mask(c, traced(c), expected));
    c.config.variant = Variant::tiles;
  }
}

TEST(ShadowMaskStop, EndsEveryVariantEarly) {
  MaskCase c = far_case(0, 0, 86, 64);
  StopFlag stop;
  ShadowMask mask;
  for (const Variant variant : all_variants) {
    c.config.variant = variant;
    stop.request();
    EXPECT_FALSE(ShadowTracer().trace_shadow_mask(seen_from(c.points, c.view), c.soup.view(), c.light,
                                                  c.config, mask, &stop));
    stop.reset();
    EXPECT_TRUE(ShadowTracer().trace_shadow_mask(seen_from(c.points, c.view), c.soup.view(), c.light,
                                                 c.config, mask, &stop));
    EXPECT_EQ(mask, oracle(c));
  }
}

// A light so far that the paper's way decides every pair exactly: minutes, unless it is stopped.
TEST(ShadowMaskStop, EndsWhatWouldTakeMinutes) {
  MaskCase c = far_case(1e15, 0, 87, 512);
  c.config.variant = Variant::precise_sorted;
  StopFlag stop;
  ShadowMask mask;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stop.request();
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(ShadowTracer().trace_shadow_mask(seen_from(c.points, c.view), c.soup.view(), c.light, c.config,
                                                mask, &stop));
  later.join();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace
}  // namespace tenebra::testing
