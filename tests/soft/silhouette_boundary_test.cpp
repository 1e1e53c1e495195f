// The boundary of what a silhouette leaves of the light, where edges lie on each other, on the light's sides,
// on the sides of what something else left of it, or are so many that the light is taken in strips: clipping
// gives the same.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "soft/soft_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

constexpr int side = 40;

/// Points on a floor, a mesh over them, a light that looks straight down with sides along x and z.
SoftCase over_floor(const std::string& name, const Soup& mesh, double half_light = 1) {
  SoftCase c;
  c.name = name;
  c.soup.quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0});
  c.soup.append(mesh);
  c.light = must(make_rectangle_light({0, 4, 0}, dvec3(half_light, 0, 0), dvec3(0, 0, half_light)));
  c.view = pinhole({0, 3, 3}, dvec3(0), 1, side, side);
  c.points.width = c.points.height = side;
  for (int i = 0; i < side * side; ++i) {  // from a lattice that the meshes' corners are on, too
    c.points.positions.emplace_back(0.0625 * (i % side - side / 2), 0, 0.0625 * (i / side - side / 2));
    c.points.triangles.push_back(0);
  }
  return c;
}

/// How many of the points were solved by the silhouette; `between`: how many see a part of the light.
std::size_t expect_what_clipping_gives(SoftCase c, std::size_t& between) {
  c.precision = SoftPrecision::reference;
  c.config.solver = SoftSolver::clip;
  const SoftMask expected = traced(c, c.config);
  c.config.solver = SoftSolver::automatic;
  const SoftMask precise = traced(c, c.config);
  c.precision = SoftPrecision::fast;
  SoftStats stats;
  const SoftMask fast = traced(c, c.config, &stats);
  const double white = white_of(c, expected);
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double fraction = expected.visible_fraction[i];
    between += fraction > 0 && fraction < 1;
    EXPECT_NEAR(precise.visible_fraction[i], fraction, 2e-7) << describe(c, i);
    EXPECT_NEAR(fast.visible_fraction[i], fraction, 2e-5) << describe(c, i);
    EXPECT_NEAR(fast.irradiance[i], expected.irradiance[i], 2e-5 * white) << describe(c, i);
  }
  return stats.points_silhouette;
}

/// A square sheet of cells, seen from below; corners on multiples of its cells' size.
Soup sheet(dvec3 corner, int across, int along, double cell) {
  Soup cells;
  for (int i = 0; i < across * along; ++i) {
    const dvec3 at = corner + cell * dvec3(i % across, 0, i / across);
    cells.quad(at, {cell, 0, 0}, {0, 0, cell});
  }
  return cells;
}

Soup both_of(Soup a, const Soup& b) {
  a.append(b);
  return a;
}

// A part of the light that is cut, for doubt, leaves fragments; a boundary leaves none.
TEST(SoftSilhouetteBoundary, NeedsNoCutsButForDoubt) {
  const Soup balls = both_of(sphere(8, 0.6, {0, 2, 0}), torus(40, 16, 0.7, 0.2).moved(1, {0.3, 1.6, 0.2}));
  const SoftCase c = over_floor("ball and ring", balls.moved(0.97, {0.013, 0.05, 0.027}));
  SoftStats stats;
  traced(c, c.config, &stats);
  EXPECT_GT(stats.points_silhouette, 1000u);
  EXPECT_GT(stats.points_penumbra, 1000u);
  EXPECT_LT(stats.fragments, stats.points_lit + stats.points_penumbra / 50);
}

TEST(SoftSilhouetteBoundary, SilhouettesThatNearlyCoincide) {
  const Soup ball = sphere(6, 0.5, {0, 2, 0}), boxes = box({-0.4, 1.9, -0.3}, {0.5, 2.2, 0.4});
  std::size_t between = 0, by_silhouette = 0;
  for (const double apart : {0.0, 1e-8, 1e-7, 1e-6, 1e-5}) {
    const auto larger = [&](const Soup& mesh) { return mesh.moved(1 + apart, dvec3(apart, 0, 0)); };
    Soup twice = both_of(ball, larger(ball));
    by_silhouette += expect_what_clipping_gives(over_floor(fmt::format("balls {}", apart), twice), between);
    twice = both_of(sheet({-0.5, 2, -0.5}, 8, 8, 0.125), larger(sheet({-0.5, 2, -0.5}, 8, 8, 0.125)));
    by_silhouette += expect_what_clipping_gives(over_floor(fmt::format("sheets {}", apart), twice), between);
    by_silhouette += expect_what_clipping_gives(
        over_floor(fmt::format("balls and boxes {}", apart), both_of(both_of(ball, boxes), larger(boxes))),
        between);
  }
  EXPECT_GT(between, 3000u);
  EXPECT_GT(by_silhouette, 3000u);
}

// The edges of neighbours lie on each other without an end in common.
TEST(SoftSilhouetteBoundary, SheetsOfUnlikeCellsSideBySide) {
  std::size_t between = 0, by_silhouette = 0;
  for (const double gap : {0.0, 1e-7, -1e-7, 1e-6}) {
    Soup sheets = sheet({-0.75, 2, -0.5}, 6, 8, 0.125);
    sheets.append(sheet({gap, 2, -0.4375}, 5, 5, 0.1875));
    sheets.append(sheet({-0.75, 2 + gap, 0.5}, 9, 5, 0.1));
    by_silhouette += expect_what_clipping_gives(over_floor(fmt::format("gap {}", gap), sheets), between);
  }
  EXPECT_GT(between, 1000u);
  EXPECT_GT(by_silhouette, 1000u);
}

// A large triangle is clipped, and the fine mesh next to it is not: its silhouette runs along what is left.
TEST(SoftSilhouetteBoundary, RunsAlongWhatIsCutOut) {
  std::size_t between = 0, by_silhouette = 0;
  for (const double turn : {0.0, 0.3}) {
    Soup wall = sheet({0, 2, -1}, 10, 16, 0.125);
    wall.quad({-4, 2, -1}, {4, 0, 0}, {0, 0, 2});
    wall.quad({0, 2, -3}, {1.25, 0, 0}, {0, 0, 2});
    for (glm::vec3& p : wall.positions)
      p = glm::vec3(static_cast<float>(std::cos(turn) * p.x - std::sin(turn) * p.z), p.y,
                    static_cast<float>(std::sin(turn) * p.x + std::cos(turn) * p.z));
    by_silhouette += expect_what_clipping_gives(over_floor(fmt::format("turn {}", turn), wall), between);
  }
  EXPECT_GT(between, 1000u);
  EXPECT_GT(by_silhouette, 1000u);
}

TEST(SoftSilhouetteBoundary, OfHundredsOfEdges) {
  Random random(17);
  std::size_t between = 0, by_silhouette = 0;
  Soup grains;
  for (int k = 0; k < 200; ++k) {
    const dvec3 centre(1.5 * random.unit() - 0.75, 1.8 + 0.4 * random.unit(), 1.5 * random.unit() - 0.75);
    grains.append(sphere(1, 0.01 + 0.04 * random.unit(), centre));
  }
  SoftCase c = over_floor("grains", grains);
  for (dvec3& p : c.points.positions) p *= 0.5;  // closer: families of groups have a silhouette in common
  by_silhouette += expect_what_clipping_gives(c, between);
  EXPECT_GT(between, 1000u);
  EXPECT_GT(by_silhouette, 1000u);
}

}  // namespace
}  // namespace tenebra::testing
