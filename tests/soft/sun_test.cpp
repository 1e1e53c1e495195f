// Suns: lights that every point sees in the same directions, against rational arithmetic and against what is
// known of their penumbrae.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <tenebra/hard_shadows.h>
#include "soft/shaft_check.h"
#include "soft/soft_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double degree = std::numbers::pi / 180;

AreaLight random_sun(Random& random) {
  const vec3 way = random.chance(0.2) ? vec3(0, 1, 0) : vec3(random.direction());
  return must(make_sun(way, random.chance(0.3) ? 0.53 : std::exp2(random.in(-8, 6.4))));
}

/// Points on triangles, or behind edges as seen from places of the sun; the eye sees each from the sun's
/// side.
SoftCase sun_case(const std::string& name, const Soup& soup, const AreaLight& sun, Random& random,
                  int count) {
  SoftCase c{name, soup, sun, {}, {}, {}, {}};
  c.view.orthographic = true;
  c.view.d0 = vec3(sun.normal);
  if (random.chance(0.3)) c.config.grouping = SoftGrouping::triangle;
  if (random.chance(0.3)) {
    c.points = points_on_triangles(soup, random, count);
    return c;
  }
  const dvec3 at = light_point(sun, 0.9 * random.unit() * sun.polygon[random.index(12)]);
  c.points = points_behind_edges(soup, {.directional = true, .to_light = vec3(at)}, random, count);
  return c;
}

TEST(Sun, IsTheDiscThatWasAskedFor) {
  for (const double diameter : {1e-6, 0.53, 10.0, 90.0}) {
    const AreaLight sun = must(make_sun({0.3f, 2, -1}, diameter));
    const double sine = std::sin(0.5 * diameter * degree), disc = std::numbers::pi * sine * sine;
    EXPECT_NEAR(sun.area_m2 / disc, 1, diameter < 11 ? 1e-4 : 0.01) << diameter;
    EXPECT_NEAR(glm::length(sun.centre), 1, 1e-15);
    EXPECT_NEAR(glm::dot(sun.centre, glm::normalize(dvec3(vec3(0.3f, 2, -1)))), 1, 1e-15);
    EXPECT_NEAR(glm::dot(glm::cross(sun.ex, sun.ey), sun.normal), 1, 1e-14) << "right-handed";
  }
  EXPECT_FALSE(make_sun({0, 0, 0}, 1));
  EXPECT_FALSE(make_sun({0, INFINITY, 0}, 1));
  for (const double diameter : {0.0, -1.0, 1e-7, 90.5, std::nan("")})
    EXPECT_FALSE(make_sun({0, 1, 0}, diameter));
}

TEST(Sun, AgreesWithRationalArithmetic) {
  Judgement sum;
  std::uint64_t seed = 0;
  for (const SoupMaker& maker : soup_makers()) {
    for (int k = 0; k < scaled(2); ++k) {
      Random random(++seed);
      const Soup soup = maker.make(random);
      judge_all(sun_case(fmt::format("{}, seed {}", maker.name, seed), soup, random_sun(random), random, 36),
                sum);
    }
  }
  sum.print("suns");
  EXPECT_GT(sum.penumbra, 100u);
}

TEST(Sun, ShaftsLoseNothing) {
  Tally tally;
  std::uint64_t seed = 0;
  for (const SoupMaker& maker : soup_makers()) {
    for (int k = 0; k < scaled(2); ++k) {
      Random random(++seed);
      Soup soup = maker.make(random);
      GroupCase c{fmt::format("{}, seed {}", maker.name, seed), std::move(soup), {}, {}, random_sun(random)};
      const SoftCase points = sun_case(c.name, c.soup, c.light, random, 100);
      c.view = points.view, c.points = points.points;
      ShaftCheck(c).run(tally, 10);
      if (HasFailure()) return;
    }
  }
  tally.print("suns");
  EXPECT_GT(tally.blocked, 200u);
  EXPECT_GT(tally.dropped, tally.kept);
}

/// A floor, and a half-plane's edge along x at height `height` above it.
SoftCase under_an_edge(double height, const AreaLight& sun, int pixels) {
  SoftCase c;
  c.name = "edge";
  c.soup.quad({-40, 0, -40}, {0, 0, 80}, {80, 0, 0});
  c.soup.quad({-400, height, 0}, {0, 0, 400}, {800, 0, 0});
  c.light = sun;
  c.view = pinhole({0, 0.5 * height, -2}, {0, 0, -0.01}, 0.8, pixels, pixels);
  c.points = view_samples(c.soup.view(), c.view, pixels, pixels);
  return c;
}

/// What a disc of radius 1 has on one side of a line, `x` from its middle: of its area.
double disc_below(double x) {
  x = std::clamp(x, -1.0, 1.0);
  return (std::acos(-x) + x * std::sqrt(1 - x * x)) / std::numbers::pi;
}

TEST(Sun, PenumbraeHaveTheWidthAndTheProfileOfADisc) {
  for (const double diameter : {0.53, 8.0}) {
    const double height = 8, tangent = std::tan(0.5 * diameter * degree);
    const SoftCase c = under_an_edge(height, must(make_sun({0, 1, 0}, diameter)), 96);
    const SoftMask mask = traced(c, SoftShadowConfig{});
    int partly = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (c.points.triangles[i] > 1) continue;
      const double z = c.points.positions[i].z;  // the edge stands over z = 0
      EXPECT_NEAR(mask.visible_fraction[i], disc_below(-z / (height * tangent)), 8e-4)
          << diameter << " " << z;
      partly += std::abs(z) < height * tangent;
    }
    EXPECT_GT(partly, 20) << diameter;
  }
}

TEST(Sun, IsAsBrightAsADirectionalLight) {
  Random random(3);
  SoftCase c = under_an_edge(8, must(make_sun({1, 2, 0.5}, 0.53)), 24);
  c.soup.triangles.resize(2);  // the floor alone
  for (std::size_t i = 0; i < c.size(); ++i)
    c.normals.push_back(vec3(glm::normalize(dvec3(0, 1, 0) + 0.5 * random.in_cube(1))));
  const SoftMask mask = traced(c, SoftShadowConfig{});
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (c.points.triangles[i] > 1) continue;
    const double cosine = glm::dot(dvec3(c.normals[i]), c.light.centre);
    EXPECT_EQ(mask.visible_fraction[i], 1);
    EXPECT_NEAR(mask.irradiance[i] / c.light.area_m2, cosine, 1e-6);
  }
}

/// A floor with bodies on it and a sun.
SoftCase below_bodies(double diameter, int pixels) {
  Random random(7);
  SoftCase c;
  c.name = "bodies";
  c.soup.quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0});
  c.soup.append(random_soup(random, 600, 0.25).moved(1.0, {0, 1.5, 0}));
  for (vec3& v : c.soup.positions) v = glm::round(1024.0f * v) / 1024.0f;  // offsets do not round these
  c.light = must(make_sun({0.4f, 1, 0.3f}, diameter));
  c.view = pinhole({0, 3, 4}, {0, 0, 0}, 0.9, pixels, pixels);
  c.points = view_samples(c.soup.view(), c.view, pixels, pixels);
  return c;
}

TEST(Sun, OfNoSizeCastsHardShadows) {
  const SoftCase c = below_bodies(1e-4, 96);
  const SoftMask soft = traced(c, SoftShadowConfig{});
  ShadowTracer tracer;
  ShadowMask hard;
  ASSERT_TRUE(tracer.trace_shadow_mask(seen_from(c.points, c.view), c.soup.view(),
                                       {.directional = true, .to_light = vec3(0.4f, 1, 0.3f)}, {}, hard));
  std::size_t partly = 0, lit = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const float fraction = soft.visible_fraction[i];
    partly += fraction > 0 && fraction < 1;
    lit += hard[i] != 0;
    if (fraction == 0 || fraction == 1) {
      EXPECT_EQ(hard[i], fraction == 1 ? 255 : 0) << describe(c, i);
    }
  }
  EXPECT_LT(partly, 20u);
  EXPECT_GT(lit, 1000u);
}

TEST(Sun, HasTheSameBitsForAllThreadsAndInstructionSets) {
  const SoftCase c = below_bodies(30, 96);
  for (const double error : {0.0, 3.0}) {
    SoftStats stats;
    const SoftMask expected = traced(c, {.error_255 = error}, &stats);
    EXPECT_EQ(error > 0, stats.points_sampled > 0);
    SoftMask mask;
    with_threads(3, [&] { mask = traced(c, {.error_255 = error}); });
    EXPECT_EQ(mask.irradiance, expected.irradiance);
    EXPECT_EQ(mask.visible_fraction, expected.visible_fraction);
    for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      EXPECT_EQ(traced(c, {.error_255 = error, .simd = level}).irradiance, expected.irradiance)
          << simd_level_name(level);
    }
  }
}

// Few triangles hide a narrow disc from any one point, however many do from all points of a group.
TEST(Sun, IsSolvedExactlyWhereItIsNarrow) {
  const SoftCase c = below_bodies(5, 48);
  SoftStats stats;
  const SoftMask mask = traced(c, {.error_255 = 2}, &stats);
  EXPECT_EQ(stats.points_sampled, 0u);
  EXPECT_EQ(mask.irradiance, traced(c, SoftShadowConfig{}).irradiance);
}

TEST(Sun, DoesNotMindWhereTheSceneStands) {
  const SoftCase here = below_bodies(5, 32);
  SoftCase there = here;
  const dvec3 offset(4096, -8192, 2048);  // floats keep 1/1024 there; the contact rule forgives 0.001
  for (vec3& v : there.soup.positions) v = vec3(dvec3(v) + offset);
  for (dvec3& p : there.points.positions) p += offset;
  there.view.eye = vec3(dvec3(there.view.eye) + offset);
  const SoftMask a = traced(here, SoftShadowConfig{}), b = traced(there, SoftShadowConfig{});
  int partly = 0, changed = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    changed += std::abs(a.visible_fraction[i] - b.visible_fraction[i]) > fast_bound;
    partly += a.visible_fraction[i] > 0 && a.visible_fraction[i] < 1;
  }
  EXPECT_GT(partly, 30);
  EXPECT_LT(changed, 20) << "where triangles pass through each other";
}

TEST(Sun, KeepsAnErrorThatIsAskedFor) {
  const SoftCase c = below_bodies(45, 96);
  const SoftMask exact = traced(c, SoftShadowConfig{});
  SoftStats stats;
  const SoftMask mask = traced(c, {.error_255 = 3}, &stats);
  const double error = error_of(c, mask, exact);
  EXPECT_GT(stats.points_sampled, 100u);
  EXPECT_LE(error, 1.3 * 3);
  EXPECT_LE(stats.error_255, 1.5 * error);
  for (const double diameter : {10, 30}) {
    const SoftCase narrower = below_bodies(diameter, 96);
    EXPECT_LE(error_of(narrower, traced(narrower, {.error_255 = 3}), traced(narrower, SoftShadowConfig{})),
              1.3 * 3)
        << diameter;
  }
}

}  // namespace
}  // namespace tenebra::testing
