// No triangle that blocks a line is ever left out, and no group is called lit or dark that is not: soups of
// every kind, every scale, near and far from the origin.
#include <fmt/core.h>

#include "soft/shafts/shafts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "soft/shaft_check.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

TEST(Shafts, NeverLeaveOutATriangleThatBlocks) {
  Tally tally;
  for (const SoupMaker& maker : soup_makers()) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      Random random(1000 + seed);
      Soup soup = maker.make(random);
      const AreaLight light = seed % 4 == 3 ? light_in_plane(soup, random) : random_light(soup, random);
      const GroupCase c =
          random_case(fmt::format("{}, seed {}", maker.name, seed), std::move(soup), light, random);
      ShaftCheck(c).run(tally, 60);
      ShaftCheck(c, SoftGrouping::triangle).run(tally, 20);
      if (HasFatalFailure()) return;
    }
  }
  tally.print("soups");
  EXPECT_GT(tally.blocked, 100000u);
  EXPECT_GT(tally.dark, 300u);
  EXPECT_GT(tally.dropped, 3 * tally.kept) << "the shafts leave out next to nothing";
}

TEST(Shafts, NeverLeaveOutATriangleThatBlocksFarFromTheOriginOrAtAnyScale) {
  Tally tally;
  for (const double offset : {1e3, 1e6, 1e8}) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
      Random random(2000);
      for (int i = 0; i < 4; ++i) {
        const Soup near = i % 2 == 0 ? room(random, 60) : tilted_wall(random);
        Soup soup = near.moved(scale, scale * offset * random.direction());
        const AreaLight light = random_light(soup, random);
        const GroupCase c = random_case(fmt::format("offset {}, scale {}, case {}", offset, scale, i),
                                        std::move(soup), light, random);
        ShaftCheck(c).run(tally, 200);
        if (HasFatalFailure()) return;
      }
    }
  }
  tally.print("far and scaled");
  EXPECT_GT(tally.blocked, 10000u);
}

// Points of a foreign G-buffer lie beside their triangles, on either side.
TEST(Shafts, NeverLeaveOutATriangleThatBlocksPointsOffTheirTriangles) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(4000 + seed);
    Soup soup = seed % 2 == 0 ? room(random, 40) : sphere(4, 1, {0, 0, 0});
    const AreaLight light = random_light(soup, random);
    GroupCase c = random_case(fmt::format("seed {}", seed), std::move(soup), light, random);
    const double off = std::pow(10.0, random.in(-6, -0.5));
    const dvec3 shift = off * random.direction();
    for (dvec3& p : c.points.positions) p += seed % 4 < 2 ? shift : off * random.direction();
    ShaftCheck(c).run(tally, 100);
    ShaftCheck(c, SoftGrouping::triangle).run(tally, 20);
    if (HasFatalFailure()) return;
  }
  tally.print("points off their triangles");
  EXPECT_GT(tally.blocked, 50000u);
}

GroupCase group_in_room(std::uint64_t seed, int size) {
  Random random(seed);
  GroupCase c;
  c.name = fmt::format("room, seed {}", seed);
  c.soup = room(random, 300);
  c.light = regular_light({0.3, 1.7, -0.4}, {-0.1, -1, 0.2}, 0.3, 4);
  c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, size, size);
  c.points = view_samples(c.soup.view(), c.view, size, size);
  return c;
}

// Coordinates times 2^k: all roundings scale with them, so the same bits decide.
TEST(Shafts, KeepTheSameTrianglesAtAnyPowerOfTwo) {
  const GroupCase c = group_in_room(31, 64);
  const std::vector<Given> expected = given(c, grouped(c));
  for (const int k : {-40, -7, 9, 40}) {
    GroupCase scaled = c;
    const double scale = std::ldexp(1.0, k);
    for (glm::vec3& v : scaled.soup.positions) v *= static_cast<float>(scale);
    for (glm::dvec3& p : scaled.points.positions) p *= scale;
    for (glm::dvec2& v : scaled.light.polygon) v *= scale;
    scaled.light.centre *= scale;
    scaled.view.eye *= static_cast<float>(scale);
    EXPECT_EQ(given(scaled, grouped(scaled)), expected) << "2^" << k;
  }
}

TEST(Shafts, AreTheSameForAnyNumberOfThreadsAndAnyInstructions) {
  const GroupCase c = group_in_room(32, 96);
  soft::ShaftStats expected_stats;
  const std::vector<Given> expected = given(c, grouped(c), SimdLevel::scalar, &expected_stats);
  for (const int threads : {1, 2, 3, 7}) {
    for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      with_threads(threads, [&] {
        soft::ShaftStats stats;
        EXPECT_EQ(given(c, grouped(c), level, &stats), expected)
            << threads << " threads, " << simd_level_name(level);
        EXPECT_EQ(stats.candidates, expected_stats.candidates);
        EXPECT_EQ(stats.points_dark, expected_stats.points_dark);
      });
    }
  }
}

TEST(Shafts, CountWhatTheyGive) {
  const GroupCase c = group_in_room(33, 64);
  const soft::PointGroups groups = grouped(c);
  soft::ShaftStats stats;
  std::uint64_t points[3] = {}, numbers[3] = {}, candidates = 0, most = 0;
  std::uint64_t in_many = 0, from_middle = 0;
  const std::vector<Given> all = given(c, groups, SimdLevel::automatic, &stats);
  for (std::size_t i = 0; i < all.size(); ++i) {
    points[static_cast<int>(all[i].kind)] += groups.groups[i].count;
    ++numbers[static_cast<int>(all[i].kind)];
    if (all[i].kind != soft::GroupClass::mixed) continue;
    candidates += all[i].candidates.size();
    EXPECT_LE(all[i].from_middle, all[i].candidates.size());
    most = std::max<std::uint64_t>(most, all[i].candidates.size());
    if (all[i].candidates.size() < 64) continue;
    in_many += all[i].candidates.size(), from_middle += all[i].from_middle;
  }
  EXPECT_EQ(stats.points_lit, points[0]);
  EXPECT_EQ(stats.points_dark, points[1]);
  EXPECT_EQ(stats.points_mixed, points[2]);
  EXPECT_EQ(stats.groups_lit, numbers[0]);
  EXPECT_EQ(stats.groups_dark, numbers[1]);
  EXPECT_EQ(stats.groups_mixed, numbers[2]);
  EXPECT_EQ(stats.candidates, candidates);
  EXPECT_EQ(stats.most_candidates, most);
  EXPECT_GT(candidates, 0u);
  EXPECT_GT(from_middle, in_many / 100);
  EXPECT_LT(from_middle, in_many) << "some of the group's are beside the middle";
  EXPECT_GT(stats.seconds, 0);
}

// What sampling leaves is solved exactly: only its groups go down the tree again.
TEST(Shafts, GiveChosenGroupsWhatTheyGiveThemAmongAll) {
  const GroupCase c = group_in_room(37, 96);
  const soft::PointGroups groups = grouped(c);
  const std::vector<Given> expected = given(c, groups);
  for (const std::uint32_t step : {1u, 3u, 40u, 100000u}) {
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = step / 2; i < groups.groups.size(); i += step) chosen.push_back(i);
    std::vector<std::uint32_t> calls(groups.groups.size());
    soft::ShaftCuller culler;
    EXPECT_TRUE(culler.for_each_family(
        groups, c.soup.view(), c.light, {}, nullptr,
        [&](std::span<const soft::GroupDecision> family, int) {
          EXPECT_FALSE(family.empty());
          for (const soft::GroupDecision& decision : family) {
            const auto i = static_cast<std::size_t>(decision.group - groups.groups.data());
            ++calls[i];
            EXPECT_EQ(decision.kind, expected[i].kind);
            EXPECT_TRUE(std::ranges::equal(decision.candidates, expected[i].candidates));
          }
        },
        chosen));
    for (const std::uint32_t i : chosen) EXPECT_EQ(std::exchange(calls[i], 0u), 1u);
    EXPECT_EQ(std::ranges::count(calls, 0u), std::ssize(calls)) << "a group that was not chosen";
    const soft::ShaftStats& s = culler.stats();
    EXPECT_EQ(s.groups_lit + s.groups_dark + s.groups_mixed, chosen.size());
  }
}

// Points times candidates of the families, as they are handed over to one thread.
std::vector<std::uint64_t> works_in_order(const GroupCase& c, const soft::PointGroups& groups) {
  std::vector<std::uint64_t> works;
  with_threads(1, [&] {
    soft::ShaftCuller culler;
    culler.for_each_family(groups, c.soup.view(), c.light, {}, nullptr,
                           [&](std::span<const soft::GroupDecision> family, int) {
                             works.push_back(0);
                             for (const soft::GroupDecision& decision : family)
                               works.back() += decision.group->count * decision.candidates.size();
                           });
  });
  return works;
}

// What takes long is not left for the end, when other threads are idle.
TEST(Shafts, HandOverTheFamiliesWithMostWorkFirst) {
  const GroupCase c = group_in_room(35, 128);
  const soft::PointGroups groups = grouped(c);
  const std::vector<std::uint64_t> works = works_in_order(c, groups);
  EXPECT_TRUE(std::is_sorted(works.rbegin(), works.rend()));
  EXPECT_GT(works.front(), works.back());
  EXPECT_LT(works.size(), groups.groups.size() / 4) << "families are small";
}

// Of 60,000 triangles below the light most may block lines from any group: too many to keep.
TEST(Shafts, HandOverBeforeAllAreDecidedWhereCandidatesAreMany) {
  GroupCase c = group_in_room(36, 128);
  Random random(36);
  for (int i = 0; i < 60000; ++i) {
    const dvec3 p = c.light.centre + dvec3(random.in(-0.3, 0.3), -0.2, random.in(-0.3, 0.3));
    c.soup.add(p + random.in_cube(0.01), p + random.in_cube(0.01), p + random.in_cube(0.01));
  }
  c.points = view_samples(c.soup.view(), c.view, 128, 128);
  const soft::PointGroups groups = grouped(c);
  const std::vector<std::uint64_t> works = works_in_order(c, groups);
  EXPECT_FALSE(std::is_sorted(works.rbegin(), works.rend())) << "all were kept";
  std::vector<Given> alone;
  with_threads(1, [&] { alone = given(c, groups); });
  with_threads(3, [&] { EXPECT_EQ(given(c, groups), alone); });
}

TEST(Shafts, EndEarlyWhenAsked) {
  const GroupCase c = group_in_room(34, 64);
  const soft::PointGroups groups = grouped(c);
  soft::ShaftCuller culler;
  StopFlag stop;
  std::size_t families = 0, handed_over = 0;
  const auto run = [&] {
    return culler.for_each_family(groups, c.soup.view(), c.light, {}, &stop,
                                  [&](std::span<const soft::GroupDecision> family, int) {
                                    handed_over += family.size();
                                    if (++families == 3) stop.request();
                                  });
  };
  with_threads(1, [&] {
    EXPECT_FALSE(run());
    EXPECT_EQ(families, 3u);
    EXPECT_FALSE(run());
    EXPECT_EQ(families, 3u);
    stop.reset();
    handed_over = 0;
    EXPECT_TRUE(run());
  });
  EXPECT_EQ(handed_over, groups.groups.size());
}

}  // namespace
}  // namespace tenebra::testing
