// The mask is the exact answer: random and adversarial soups, lights where they hurt, views and chosen
// points.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "shadow/mask_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

struct Place {
  const char* name;
  double scale;
  dvec3 offset;
};
const Place places[] = {{"as made", 1, dvec3(0)},         {"x 2^-40", 0x1p-40, dvec3(0)},
                        {"x 2^40", 0x1p40, dvec3(0)},     {"+ 1e3", 1, {1e3, -1e3, 1e3}},
                        {"+ 1e6", 100, {1e6, 2e6, -1e6}}, {"+ 1e8", 1e4, {1e8, -1e8, 5e7}}};

/// Lights of the catalogue, by number.
constexpr int light_kinds = 10;
ShadowLight light_of_kind(int kind, const Soup& soup, Random& random) {
  const dvec3 low = soup.low(), size = soup.high() - low, middle = low + 0.5 * size;
  const auto id = random.index(static_cast<std::uint32_t>(soup.triangles.size()));
  const dvec3 a(soup.corner(id, 0)), b(soup.corner(id, 1)), c(soup.corner(id, 2));
  const double extent = std::max({size.x, size.y, size.z});
  switch (kind) {
    case 0:
      return point_light(low + size * dvec3(random.unit(), random.in(0.9, 1.5), random.unit()));
    case 1:
      return point_light(middle + 0.3 * size * random.in_cube(1));  // inside: all directions
    case 2:
      return sun(random.direction());
    case 3:
      return sun({0, 1, 0});
    case 4:
      return point_light(a + random.in(-2, 2) * (b - a) +
                         random.in(-2, 2) * (c - a));  // on a plane, or an ulp off
    case 5:
      return point_light(a + random.unit() * (b - a));  // on an edge
    case 6:
      return point_light(a);  // on a vertex
    case 7:
      return point_light(middle + 1e6 * extent * random.direction());
    case 8:
      return point_light(a + 1e-6 * extent * random.direction());  // close to a surface
    default:
      return point_light(middle + 1e9 * extent * random.direction());
  }
}

MaskCase soup_case(const SoupMaker& maker, const Place& place, int kind, std::uint64_t seed) {
  Random random(seed);
  MaskCase c;
  c.name = fmt::format("{} {}, light kind {}, seed {}", maker.name, place.name, kind, seed);
  c.soup = maker.make(random).moved(place.scale, place.offset);
  if (seed % 3 == 0)
    for (std::size_t i = 0; i < c.soup.triangles.size(); ++i) c.soup.casts.push_back(random.chance(0.9));
  c.light = light_of_kind(kind, c.soup, random);
  c.config.variant = all_variants[seed % std::size(all_variants)];
  c.config.cull_front = seed % 11 == 0;
  c.view = view_from_light(c.light);
  return c;
}

TEST(ShadowMask, IsExactForPointsOnEverySoup) {
  Shares shares;
  std::uint64_t seed = 100;
  for (const SoupMaker& maker : soup_makers())
    for (const Place& place : places) {
      ++seed;
      const int kind = static_cast<int>(seed % light_kinds);
      MaskCase c = soup_case(maker, place, kind, seed);
      Random random(seed);
      c.points = points_on_triangles(c.soup, random, 6000);
      EXPECT_TRUE(exact(c, &shares));
    }
  shares.print("points on soups");
  EXPECT_GE(shares.samples, 600000u);
}

TEST(ShadowMask, IsExactForPointsBehindEdgesAndVertices) {
  Shares shares;
  std::uint64_t seed = 1000;
  for (const SoupMaker& maker : soup_makers())
    for (const int kind : {0, 1, 2, 7}) {
      ++seed;
      MaskCase c = soup_case(maker, places[seed % std::size(places)], kind, seed);
      Random random(seed);
      c.points = points_behind_edges(c.soup, c.light, random, 3000);
      EXPECT_TRUE(exact(c, &shares));
    }
  shares.print("points behind edges and vertices");
  EXPECT_GE(shares.samples, 50000u);
  EXPECT_GT(shares.double_unknown, 100u) << "the adversary is too kind";
}

TEST(ShadowMask, IsExactInViewsOfEverySoup) {
  Shares shares;
  std::uint64_t seed = 2000;
  for (const SoupMaker& maker : soup_makers())
    for (const int kind : {0, 1, 2, 4}) {
      ++seed;
      MaskCase c = soup_case(maker, places[seed % 2 == 0 ? 0 : seed % std::size(places)], kind, seed);
      Random random(seed);
      const dvec3 low = c.soup.low(), size = c.soup.high() - low, middle = low + 0.5 * size;
      c.view = pinhole(middle + 1.2 * size * random.direction(), middle, 0.6, 160, 150);
      if (seed % 5 == 0) c.view.eye = c.light.directional ? c.view.eye : c.light.position;
      c.points = view_samples(c.soup.view(), c.view, 160, 150);
      EXPECT_TRUE(exact(c, &shares));
    }
  shares.print("views of soups");
}

/// Large samples of one plain scene a seed: the bulk of the two million.
TEST(ShadowMask, IsExactInLargeViewsOfRooms) {
  Shares shares;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    MaskCase c;
    c.name = fmt::format("large view of a room, seed {}", seed);
    c.soup = room(random, 2000);
    c.light = seed % 3 == 0 ? sun({0.3, 1, 0.2}) : point_light(random.in_cube(0.8));
    c.view = pinhole({-1.8, 1.5, -1.7}, random.in_cube(0.5), 0.9, 512, 512);
    c.points = view_samples(c.soup.view(), c.view, 512, 512);
    c.config.variant = all_variants[seed];
    EXPECT_TRUE(exact(c, &shares));
  }
  shares.print("large views of rooms");
  EXPECT_GE(shares.samples, 1400000u);
}

TEST(ShadowMask, IsTheSameForAllVariants) {
  std::uint64_t seed = 3000;
  for (const SoupMaker& maker : soup_makers())
    for (const int kind : {0, 1, 2}) {
      ++seed;
      MaskCase c = soup_case(maker, places[0], kind, seed);
      c.config.cull_front = false;
      Random random(seed);
      c.points = points_on_triangles(c.soup, random, 3000);
      EXPECT_TRUE(all_variants_give(c, oracle(c)));
    }
}

TEST(ShadowMask, IsTheSameForAllInstructionSets) {
  std::uint64_t seed = 4000;
  for (const SoupMaker& maker : soup_makers()) {
    ++seed;
    MaskCase c =
        soup_case(maker, places[seed % std::size(places)], static_cast<int>(seed % light_kinds), seed);
    Random random(seed);
    c.points = points_on_triangles(c.soup, random, 4000);
    const ShadowMask expected = oracle(c);
    for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      c.config.simd = level;
      EXPECT_TRUE(same_mask(c, traced(c), expected));
    }
  }
}

TEST(ShadowMask, IsTheSameForAnyNumberOfThreads) {
  Random random(5);
  MaskCase c;
  c.soup = room(random, 2000);
  c.light = point_light({0.2, 1.6, -0.3});
  c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, 400, 300);
  c.points = view_samples(c.soup.view(), c.view, 400, 300);
  const ShadowMask expected = oracle(c);
  for (const int threads : {1, 2, 3, 8, 64}) {
    c.name = fmt::format("{} threads, seed 5", threads);
    with_threads(threads, [&] { EXPECT_TRUE(all_variants_give(c, expected)); });
  }
}

TEST(ShadowMask, IsExactWithoutContactRule) {
  Shares shares;
  std::uint64_t seed = 5000;
  for (const SoupMaker& maker : soup_makers()) {
    ++seed;
    MaskCase c = soup_case(maker, places[0], static_cast<int>(seed % 3), seed);
    c.config.contact = ContactRule::none;
    c.config.cull_front = seed % 2 == 0;
    Random random(seed);
    c.points = points_on_triangles(c.soup, random, 1000);
    EXPECT_TRUE(exact(c, &shares));
  }
  shares.print("without contact rule");
}

TEST(ShadowMask, IsExactForSpotsAndRanges) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    MaskCase c;
    c.name = fmt::format("spot, seed {}", seed);
    c.soup = random_soup(random, 200, 0.5);
    c.light = point_light(random.in_cube(2));
    c.light.spot_axis = glm::vec3(random.direction());
    c.light.spot_cos_outer = static_cast<float>(random.in(-1, 1));
    c.light.range_m = random.chance(0.5) ? static_cast<float>(random.in(1, 3)) : 0.0f;
    c.view = view_from_light(c.light);
    c.points = points_on_triangles(c.soup, random, 3000);
    EXPECT_TRUE(exact(c));
  }
}

}  // namespace
}  // namespace tenebra::testing
