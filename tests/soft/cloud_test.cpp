// Clouds of loose triangles: what took light from the last points goes first, and the others are found
// through the bounds of their blocks.
#include <gtest/gtest.h>

#include <cmath>

#include "soft/soft_case.h"

namespace tenebra::testing {
namespace {

/// A floor below, a cloud of loose triangles between, a light above.
SoftCase below_cloud(const std::string& name, int count, double size, int pixels, std::uint64_t seed) {
  Random random(seed);
  SoftCase c;
  c.name = name;
  c.soup.quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0});
  c.soup.append(random_soup(random, count, size).moved(1.2, {0, 2.5, 0}));
  c.light = square_light({0.4, 6, -0.3}, {0, 0, 0}, 1.5);
  c.view = pinhole({0, 1.1, 4}, {0, 0, 0}, 0.9, pixels, pixels);
  c.points = view_samples(c.soup.view(), c.view, pixels, pixels);
  return c;
}

/// Points of each kind, by what is expected of them.
struct Seen {
  std::size_t between = 0, dark_on_floor = 0;
};

/// Traces with c's configuration; fractions are within the bound of its precision.
void expect_near(const SoftCase& c, const SoftMask& expected, Seen& seen) {
  const SoftMask mask = traced(c, c.config);
  const double bound = c.precision == SoftPrecision::reference ? 1e-6 : fast_bound;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const float e = expected.visible_fraction[i];
    seen.between += e > 0 && e < 1;
    seen.dark_on_floor += e == 0 && c.points.triangles[i] < 2;
    EXPECT_NEAR(mask.visible_fraction[i], e, bound) << describe(c, i);
  }
}

TEST(SoftCloud, IsExact) {
  Judgement sum;
  judge_all(below_cloud("400 leaves, seed 91", 400, 0.35, 16, 91), sum);
  judge_all(below_cloud("1,200 leaves, seed 92", 1200, 0.15, 16, 92), sum);
  sum.print("clouds");
  EXPECT_GT(sum.penumbra, 150u);
}

// 3,000 leaves fill blocks by the hundred: clipping takes all its ways. The BSP shares none of them but for
// the leaves that points lie on both sides of.
TEST(SoftCloud, GivesWhatTheBspGives) {
  Seen seen;
  for (const auto& [count, size] : {std::pair(700, 0.5), std::pair(3000, 0.12)}) {
    SoftCase c = below_cloud("leaves, seed 93", count, size, 20, 93);
    c.precision = SoftPrecision::reference;
    c.config.solver = SoftSolver::bsp;
    const SoftMask expected = traced(c, c.config);
    for (const SoftPrecision precision : {SoftPrecision::reference, SoftPrecision::fast}) {
      c.config.solver = SoftSolver::clip;
      c.precision = precision;
      expect_near(c, expected, seen);
    }
  }
  EXPECT_GT(seen.between, 400u);
  EXPECT_GT(seen.dark_on_floor, 40u);
}

// So many leaves, and halves of leaves, before each group of points that neighbours make them ready together.
TEST(SoftCloud, GroupsTogetherSeeWhatEachSees) {
  SoftCase c = below_cloud("5,000 leaves, seed 94", 5000, 0.1, 32, 94);
  Random random(95);
  for (int i = 0; i < 1500; ++i)
    c.soup.quad(glm::dvec3(0, 2.5, 0) + random.in_cube(1), random.in_cube(0.06), random.in_cube(0.06));
  c.config.solver = SoftSolver::clip;
  c.precision = SoftPrecision::reference;
  const SoftMask expected = traced(c, c.config);
  Seen seen;
  for (const SoftPrecision precision : {SoftPrecision::reference, SoftPrecision::fast}) {
    c.config.solver = SoftSolver::automatic;
    c.precision = precision;
    expect_near(c, expected, seen);
  }
  EXPECT_GT(seen.between, 400u);
}

}  // namespace
}  // namespace tenebra::testing
