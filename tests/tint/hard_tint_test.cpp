// Lights without an area through glass: against Embree with a filter that multiplies, and where rays meet
// edges and vertices exactly.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "formats/import_scene.h"
#include "parallel/parallel.h"
#include "tint/glass_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using glm::vec3;

Soup square(dvec3 corner, dvec3 u, dvec3 v) {
  Soup soup;
  soup.quad(corner, u, v);
  return soup;
}

Soup ground() {
  return square({-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
}

ShadowLight point_light(vec3 at) {
  ShadowLight light;
  light.position = at;
  return light;
}

ShadowLight sun(vec3 to_light) {
  ShadowLight light;
  light.directional = true;
  light.to_light = to_light;
  return light;
}

double difference(const vec3& a, const dvec3& b) {
  const dvec3 d = glm::abs(dvec3(a) - b);
  return std::max({d.x, d.y, d.z});
}

struct Compared {
  std::size_t lit = 0, tinted = 0, beside_edges = 0;
};

/// Each lit sample must be within 1/255 of Embree; where it is not, Embree must say so of a ray beside it,
/// for its floats cannot tell on which side of an edge a ray runs.
Compared compare(const Glass& glass, const VisiblePoints& points, const ViewRays& view,
                 const ShadowLight& light) {
  ShadowMask lit;
  const TintMask tint = traced(glass, points, view, light, &lit);
  const std::vector<vec3> factors = spread(tint, points.triangles.size());
  GlassPeer peer(glass);
  Compared result;
  result.tinted = tint.pixels.size();
  const auto peers = [&](dvec3 p, std::uint32_t own) {
    return peer.passed(p, light.directional ? dvec3(light.to_light) : dvec3(light.position) - p, own,
                       light.directional);
  };
  for (std::size_t i = 0; i < points.triangles.size(); ++i) {
    if (lit[i] == 0) continue;
    ++result.lit;
    const dvec3 p = points.positions[i];
    const std::uint32_t own = points.triangles[i];
    if (difference(factors[i], peers(p, own)) <= 1.0 / 255) continue;
    ++result.beside_edges;
    double nearest = 1;
    for (int k = 0; k < 27; ++k) {
      const dvec3 beside(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      nearest = std::min(nearest, difference(factors[i], peers(p + 2e-5 * beside, own)));
    }
    const vec3 f = factors[i];
    const dvec3 e = peers(p, own);
    EXPECT_LE(nearest, 1.0 / 255) << "pixel " << i << ": " << f.x << ' ' << f.y << ' ' << f.z << ", Embree "
                                  << e.x << ' ' << e.y << ' ' << e.z;
  }
  return result;
}

Glass stack_of_panes() {
  Glass glass;
  glass.add(ground(), Material{});
  glass.add(box({-0.5, 0, -0.5}, {0.5, 0.7, 0.5}), Material{});
  glass.add(square({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), pane({0.9f, 0.3f, 0.2f}, 0.8f));
  glass.add(square({-0.5, 1.5, 1.5}, {2, 0, 0}, {0, 0.2, -2}), pane({0.1f, 0.8f, 0.9f}, 1.0f));
  glass.add(square({-1.5, 2, 0.5}, {2, 0.3, 0}, {0, 0, -2}), blend(0.4f));
  glass.add(square({-1.2, 2.2, 1.2}, {2.4, 0, 0}, {0, 0, -2.4}), pane({1, 1, 1}, 0.5f, false));
  return glass;
}

const ViewRays above = pinhole({0.3, 6, 5}, {0, 0, 0}, 0.5, 96, 96);

TEST(HardTint, StacksOfPanesAreWhatEmbreeMultiplies) {
  const Glass glass = stack_of_panes();
  const VisiblePoints points = glass.samples(above, 96, 96);
  for (const ShadowLight& light :
       {point_light({0.2f, 5, 0.1f}), point_light({2, 3, 1}), sun({0.3f, 1, 0.2f})}) {
    const Compared c = compare(glass, points, above, light);
    EXPECT_GT(c.tinted, 500u);
    EXPECT_LT(c.beside_edges, c.lit / 100);
  }
}

TEST(HardTint, TexturesAndVertexColoursAreThoseOfTheCrossing) {
  Glass glass;
  glass.add(ground(), Material{});
  glass.scene.images.push_back(waves(32));
  const auto place = [](vec3 p) { return glm::vec2(0.7f * p.x + 0.1f, 0.9f * p.z - 3.3f); };
  Material window = pane({0.9f, 0.8f, 1}, 0.9f);
  window.base_color_map.image = 0;
  glass.add(square({-1, 1, 1}, {2, 0, 0}, {0, 0.4, -2}), window, place);
  Material leaf = blend(0.9f);
  leaf.base_color_map.image = 0;
  glass.add(square({-1.5, 2, 1}, {2, 0, 0}, {0, 0, -2}), leaf, place);
  Material frosted = pane({1, 1, 1}, 1, false);
  frosted.transmission_map.image = 0;
  glass.add(square({-0.5, 2.5, 1}, {2, 0, 0}, {0, 0, -2}), frosted, place);
  const std::size_t first = glass.soup.positions.size();
  glass.add(square({-2, 1.5, 0}, {3, 0, 0}, {0, 0, -2}), pane({1, 1, 1}, 1));
  for (std::size_t i = first; i < glass.colors.size(); ++i)
    glass.colors[i] = {0.2f + 0.1f * static_cast<float>(i - first), 0.9f, 0.5f, 1};
  const VisiblePoints points = glass.samples(above, 96, 96);
  for (const Transfer transfer : {Transfer::srgb, Transfer::display}) {
    glass.scene.transfer = transfer;
    const Compared c = compare(glass, points, above, point_light({0.2f, 5, 0.1f}));
    EXPECT_GT(c.tinted, 500u);
    EXPECT_LT(c.beside_edges, c.lit / 100);
  }
}

TEST(HardTint, SoupsAreWhatEmbreeMultiplies) {
  std::size_t tinted = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    Glass glass;
    glass.add(ground(), Material{});
    for (int k = 0; k < 4; ++k) {
      const auto unit = [&] { return static_cast<float>(random.unit()); };
      const Material material = k == 3 ? blend(unit()) : pane({unit(), unit(), unit()}, 0.5f + 0.5f * unit());
      glass.add(random_soup(random, 60, 0.6).moved(1.5, {0, 2, 0}), material);
    }
    const ShadowLight light = seed % 3 == 0 ? sun({0.2f, 1, -0.1f}) : point_light({0.1f, 6, 0.2f});
    const Compared c = compare(glass, glass.samples(above, 64, 64), above, light);
    tinted += c.tinted;
    EXPECT_LT(c.beside_edges, c.lit / 20 + 1);
  }
  EXPECT_GT(tinted, 3000u);
}

/// A sheet of squares in the plane y = 2 with corners in whole numbers, diagonals and windings at random.
Soup sheet(Random& random, int half) {
  Soup soup;
  for (int x = -half; x < half; ++x)
    for (int z = -half; z < half; ++z) {
      const dvec3 a(x, 2, z), b(x + 1, 2, z), c(x + 1, 2, z + 1), d(x, 2, z + 1);
      const bool other = random.chance(0.5);
      std::array<dvec3, 3> one = other ? std::array{a, b, c} : std::array{b, c, d};
      std::array<dvec3, 3> two = other ? std::array{a, c, d} : std::array{b, d, a};
      if (random.chance(0.5)) std::swap(one[0], one[1]);
      if (random.chance(0.5)) std::swap(two[1], two[2]);
      soup.add(one[0], one[1], one[2]);
      soup.add(two[0], two[1], two[2]);
    }
  return soup;
}

/// Points of the ground whose rays meet the sheet in multiples of `step`.
VisiblePoints grid_points(double step, double stretch) {
  VisiblePoints points;
  points.width = points.height = 33;
  for (int i = 0; i < 33 * 33; ++i) {
    const dvec3 met((i % 33 - 16) * step, 0, (i / 33 - 16) * step);
    points.positions.push_back(stretch * met);
    points.triangles.push_back(met.x * 1.0 + met.z * 1.0 > 0 ? 0u : 1u);
  }
  return points;
}

TEST(HardTint, RaysThroughEdgesAndVerticesCrossASheetOnce) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    Glass glass;
    glass.add(square({-64, 0, 64}, {128, 0, 0}, {0, 0, -128}), Material{});
    glass.add(sheet(random, 6), pane({0.75f, 0.5f, 0.25f}, 0.5f));
    const bool directional = seed % 2 == 0;
    const ShadowLight light = directional ? sun({0, 1, 0}) : point_light({0, 4, 0});
    for (const double step : {0.25, 0.125, 1.0 / 3}) {
      const VisiblePoints points = grid_points(step, directional ? 1 : 2);
      TintStats stats;
      const TintMask tint = traced(glass, points, view_from_light(light), light, nullptr, &stats);
      ASSERT_EQ(tint.pixels.size(), points.triangles.size()) << "seed " << seed << ", step " << step;
      for (const vec3& factor : tint.factors) ASSERT_EQ(factor, vec3(0.375f, 0.25f, 0.125f));
      if (step != 1.0 / 3) {
        EXPECT_GT(stats.exact, 300u);
      }
    }
  }
}

TEST(HardTint, ClosedBodiesAreCrossedTwiceOrNotAtAll) {
  const std::vector<Soup> bodies = {box({-1, 1, -1}, {1, 2, 1}), sphere(6, 1, {0, 2, 0}),
                                    sphere(9, 1.25, {0, 2.5, 0})};
  for (const Soup& body : bodies)
    for (const ShadowLight& light :
         {point_light({0, 8, 0}), point_light({0.5f, 6, 0.25f}), sun({0, 1, 0}), sun({1, 2, 0})}) {
      Glass glass;
      glass.add(square({-32, 0, 32}, {64, 0, 0}, {0, 0, -64}), Material{});
      glass.add(body, pane({1, 1, 1}, 0.5f));
      // On the ground, behind places, edges and vertices of the body, exactly where the numbers allow it.
      Random random(7);
      VisiblePoints points = points_behind_edges(glass.soup, light, random, 3000);
      for (std::uint32_t& id : points.triangles)
        if (id != no_triangle && id > 1) id = no_triangle;
      const TintMask tint = traced(glass, points, view_from_light(light), light);
      EXPECT_GT(tint.pixels.size(), 300u);
      // A ball of flat quads is not convex everywhere: a few rays enter it twice.
      std::size_t twice = 0;
      for (const vec3& factor : tint.factors) {
        ASSERT_TRUE(factor == vec3(0.25f) || (factor == vec3(0.0625f) && &body != &bodies[0])) << factor.x;
        twice += factor == vec3(0.0625f);
      }
      EXPECT_LE(twice, tint.factors.size() / 50);
    }
}

TEST(HardTint, NeitherOrderNorThreadsChangeABit) {
  Random random(3);
  Glass glass;
  glass.add(ground(), Material{});
  for (int k = 0; k < 5; ++k)
    glass.add(random_soup(random, 40, 0.8).moved(1.5, {0, 2, 0}),
              pane({random.unit(), random.unit(), random.unit()}, 0.9f));
  const VisiblePoints points = glass.samples(above, 80, 80);
  const ShadowLight light = point_light({0.1f, 6, 0.2f});
  const std::vector<vec3> expected = spread(traced(glass, points, above, light), points.triangles.size());
  for (const int threads : {1, 2, 5}) {
    TintMask tint;
    with_threads(threads, [&] { tint = traced(glass, points, above, light); });
    EXPECT_EQ(spread(tint, points.triangles.size()), expected) << threads;
  }
  Glass other = glass;
  for (std::size_t i = glass.see_through.size() - 1; i > 2; --i) {  // the ground stays: points name it
    const std::size_t k = 2 + random.index(static_cast<std::uint32_t>(i - 1));
    std::swap(other.soup.triangles[i], other.soup.triangles[k]);
    std::swap(other.materials[i], other.materials[k]);
  }
  EXPECT_EQ(spread(traced(other, points, above, light), points.triangles.size()), expected);
}

TEST(HardTint, NothingSeeThroughNamesNoPixel) {
  Glass glass;
  glass.add(ground(), Material{});
  EXPECT_TRUE(traced(glass, glass.samples(above, 32, 32), above, point_light({0, 5, 0})).pixels.empty());
  Glass clear = glass;
  clear.add(square({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), blend(0.0f));
  EXPECT_TRUE(traced(clear, clear.samples(above, 32, 32), above, point_light({0, 5, 0})).pixels.empty());
}

TEST(HardTint, DegenerateAndEdgeOnPanesAreNotCrossed) {
  Random random(11);
  Glass glass;
  glass.add(ground(), Material{});
  glass.add(with_zero_areas(random, 200).moved(1, {0, 2, 0}), pane({1, 1, 1}, 0.5f));
  glass.add(square({-1, 1, 0}, {2, 0, 0}, {0, 2, 0}), pane({1, 1, 1}, 0.5f));  // in a plane through the light
  const Compared c = compare(glass, glass.samples(above, 64, 64), above, point_light({0, 5, 0}));
  EXPECT_GT(c.tinted, 50u);
}

TEST(HardTint, StopsWhenAsked) {
  const Glass glass = stack_of_panes();
  const VisiblePoints points = glass.samples(above, 96, 96);
  const ShadowLight light = point_light({0.2f, 5, 0.1f});
  const ShadowMask lit(points.triangles.size(), 255);
  StopFlag stop;
  TintTracer tracer;
  TintMask out;
  EXPECT_TRUE(tracer.trace(seen_from(points, above), glass.soup.view(), glass.surfaces(), light, lit, {}, out,
                           &stop));
  EXPECT_GT(tracer.stats().tests, 0u);
  stop.request();
  EXPECT_FALSE(tracer.trace(seen_from(points, above), glass.soup.view(), glass.surfaces(), light, lit, {},
                            out, &stop));
  EXPECT_EQ(tracer.stats().tests, 0u);
}

}  // namespace
}  // namespace tenebra::testing
