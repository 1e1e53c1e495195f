// The oracle itself: hand cases, and against a second oracle that is slow and obvious.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "oracle/dyadic.h"
#include "points/contact_rule.h"
#include "reference/rational_mask.h"
#include "shadow/mask_case.h"

namespace tenebra::testing {
namespace {

using oracle::Bounded;
using oracle::Dyadic;

TEST(Dyadic, IsExactOverTheWholeRangeOfDoubles) {
  const Dyadic tiny(0x1p-1074), huge(0x1.fffffffffffffp1023);
  EXPECT_EQ(((huge + tiny) - huge - tiny).sign(), 0);
  EXPECT_EQ(((huge + tiny) - huge).sign(), 1);
  EXPECT_EQ((huge * tiny - tiny * huge).sign(), 0);
  EXPECT_EQ((Dyadic(-3.5) * Dyadic(2.0) + Dyadic(7.0)).sign(), 0);
  EXPECT_EQ(Dyadic(-0.0).sign(), 0);
}

TEST(Bounded, NeverClaimsAWrongSign) {
  Random random(1);
  int claimed = 0;
  for (int i = 0; i < 200000; ++i) {
    const double a = random.power_of_two(-60, 60), b = random.power_of_two(-60, 60), c = random.in(-2, 2);
    const double d = a * b / c * (random.chance(0.5) ? 1 : 1 + 0x1p-52);  // a b - c d is close to nothing
    const int sign = (Bounded(a) * Bounded(b) - Bounded(c) * Bounded(d)).sign();
    const int exact = (Dyadic(a) * Dyadic(b) - Dyadic(c) * Dyadic(d)).sign();
    if (sign == oracle::unknown_sign) continue;
    ++claimed;
    ASSERT_EQ(sign, exact) << "case " << i;
  }
  const Bounded overflow = Bounded(1e300) * Bounded(1e300);
  EXPECT_EQ((overflow - overflow).sign(), oracle::unknown_sign);
  EXPECT_EQ((Bounded(1e-200) * Bounded(1e-200) - Bounded(1e-201) * Bounded(1e-200)).sign(),
            oracle::unknown_sign);
  EXPECT_GT(claimed, 1000);
}

/// Light 4 above the ground y = 0, an occluder in y = 2 with corners (0,2,0), (1,2,0), (0,2,1): its shadow
/// has the corners (0,0,0), (2,0,0), (0,0,2), edges included.
MaskCase hand_case() {
  MaskCase c;
  c.name = "hand case";
  c.soup.add({0, 2, 0}, {1, 2, 0}, {0, 2, 1});
  c.soup.add({-9, 0, -9}, {0, 0, 27}, {27, 0, -9});
  c.light = point_light({0, 4, 0});
  c.view = view_from_light(c.light);
  for (const auto& [x, z] : {std::pair{0.5, 0.5},
                             {2.0, 0.0},
                             {0.0, 0.0},
                             {1.0, 1.0},
                             {1.0, 1.0 + 0x1p-50},
                             {-0x1p-1000, 0.5},
                             {3.0, 3.0},
                             {0.0, 2.0}})
    c.points.positions.emplace_back(x, 0, z), c.points.triangles.push_back(1);
  c.points.positions.emplace_back(0.25, 2, 0.25), c.points.triangles.push_back(0);
  c.points.positions.emplace_back(0), c.points.triangles.push_back(no_triangle);
  c.points.width = 10, c.points.height = 1;
  return c;
}

TEST(Oracle, AnswersHandCases) {
  const MaskCase c = hand_case();
  const ShadowMask expected{0, 0, 0, 0, 255, 255, 255, 0, 255, 0};
  EXPECT_EQ(oracle(c), expected);
  EXPECT_EQ(reference::rational_mask(c.points, c.view, c.soup.view(), c.light, c.config), expected);
  EXPECT_TRUE(all_variants_give(c, expected));
}

TEST(Oracle, CullsFrontsAndHonoursCastFlags) {
  MaskCase c = hand_case();
  c.config.cull_front = true;  // (B-A) x (C-A) = -y: the occluder turns away from the light and still casts
  EXPECT_EQ(oracle(c)[0], 0);
  EXPECT_TRUE(exact(c));
  std::swap(c.soup.triangles[0].y, c.soup.triangles[0].z);
  EXPECT_EQ(oracle(c)[0], 255);
  EXPECT_TRUE(exact(c));
  c.config.cull_front = false;
  c.soup.casts = {0, 1};
  EXPECT_EQ(oracle(c)[0], 255);
  EXPECT_TRUE(exact(c));
}

TEST(Oracle, KeepsPointsWithinTheContactHeightLit) {
  MaskCase c = hand_case();
  const double height = oracle::vertex_rounding({0, 2, 0}, {1, 2, 0}, {0, 2, 1}) +
                        oracle::vertex_rounding({-9, 0, -9}, {0, 0, 27}, {27, 0, -9});
  EXPECT_NEAR(height, std::sqrt(3.0) * 0x1p-24 * 29, 1e-20);
  c.points.positions = {{0.25, 2 - height * 0.999, 0.25}, {0.25, 2 - height * 1.001, 0.25}};
  c.points.triangles = {1, 1};
  c.points.width = 2;
  EXPECT_EQ(oracle(c), (ShadowMask{255, 0}));
  EXPECT_TRUE(exact(c));
}

TEST(Oracle, AgreesWithRationalsOnEverySoup) {
  oracle::ExactMaskStats stats;
  std::size_t shadowed = 0, lit = 0;
  for (const SoupMaker& maker : soup_makers())
    for (const std::uint64_t seed : {1u, 2u}) {
      Random random(seed);
      MaskCase c;
      c.name = fmt::format("{}, seed {}", maker.name, seed);
      const Soup whole = maker.make(random);
      for (int i = 0; i < 60; ++i) {  // a few triangles: rationals are slow
        const auto id = random.index(static_cast<std::uint32_t>(whole.triangles.size()));
        c.soup.add(whole.corner(id, 0), whole.corner(id, 1), whole.corner(id, 2));
      }
      const glm::dvec3 size = c.soup.high() - c.soup.low();
      c.light =
          seed == 1
              ? point_light(c.soup.low() + size * glm::dvec3(random.unit(), random.in(0.5, 2), random.unit()))
              : sun(random.direction());
      c.config.cull_front = random.chance(0.3);
      if (random.chance(0.3)) c.light.range_m = static_cast<float>(0.7 * glm::length(size));
      if (random.chance(0.3)) c.light.spot_cos_outer = random.chance(0.5) ? 0.3f : -0.3f;
      c.view = view_from_light(c.light);
      c.points = random.chance(0.5) ? points_on_triangles(c.soup, random, 40)
                                    : points_behind_edges(c.soup, c.light, random, 40);
      const ShadowMask mask = oracle(c, &stats);
      EXPECT_TRUE(
          same_mask(c, mask, reference::rational_mask(c.points, c.view, c.soup.view(), c.light, c.config)));
      for (const std::uint8_t value : mask) (value == 0 ? shadowed : lit) += 1;
    }
  EXPECT_GT(stats.exact, 100u);
  EXPECT_GT(shadowed, 200u);
  EXPECT_GT(lit, 100u);
}

TEST(Oracle, CandidateSearchLosesNoBlocker) {
  for (const SoupMaker& maker : soup_makers()) {
    Random random(7);
    MaskCase c;
    c.soup = maker.make(random);
    c.light = random.chance(0.7) ? point_light(random.in_cube(2)) : sun(random.direction());
    const oracle::ExactShadow judge(view_from_light(c.light), c.soup.view(), c.light, c.config);
    for (const bool aimed : {false, true}) {
      const VisiblePoints points = aimed ? points_behind_edges(c.soup, c.light, random, 300)
                                         : points_on_triangles(c.soup, random, 300);
      oracle::ExactMaskStats stats;
      for (std::size_t i = 0; i < points.positions.size() && points.triangles[i] != no_triangle; ++i)
        ASSERT_EQ(judge.blocker(points.positions[i], points.triangles[i], stats) == no_triangle,
                  judge.blocker_among_all(points.positions[i], points.triangles[i], stats) == no_triangle)
            << maker.name << ", seed 7, sample " << i;
    }
  }
}

TEST(Oracle, UsesTheSameContactHeightAsTheTracer) {
  Random random(3);
  for (int i = 0; i < 100000; ++i) {
    glm::vec3 t[3];
    for (glm::vec3& p : t)
      for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(random.power_of_two(-30, 30));
    const glm::dvec3 a(t[0]), b(t[1]), c(t[2]);
    const double tau = oracle::vertex_rounding(a, b, c), other = tau * random.unit();
    ASSERT_EQ(points::rounding_tolerance(t), tau) << "seed 3, case " << i;
    ASSERT_EQ(points::contact_threshold(t, tau, other), oracle::contact_height(a, b, c, tau + other))
        << "case " << i;
  }
}

}  // namespace
}  // namespace tenebra::testing
