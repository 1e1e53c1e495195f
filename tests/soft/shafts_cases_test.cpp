// Shafts whose answer is known by hand.
#include <gtest/gtest.h>

#include "soft/shaft_check.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

/// A floor of 2 * cells^2 triangles in the plane y = 0, -4..4, seen from above; a square light of
/// half-diagonal 0.5 at y = 4, facing down.
GroupCase floor_case(int cells, int pixels) {
  GroupCase c;
  c.name = "floor";
  const double step = 8.0 / cells;
  for (int z = 0; z < cells; ++z)
    for (int x = 0; x < cells; ++x)
      c.soup.quad({-4 + x * step, 0, -4 + z * step}, {0, 0, step}, {step, 0, 0});
  c.light = regular_light({0, 4, 0}, {0, -1, 0}, 0.5, 4);
  c.view = pinhole({0, 3, 0}, {0, 0, 0}, 0.9, pixels, pixels);
  return c;
}
void see(GroupCase& c, int pixels) {
  c.points = view_samples(c.soup.view(), c.view, pixels, pixels);
}

Tally kinds(const GroupCase& c) {
  Tally tally;
  ShaftCheck(c).run(tally, 20);
  return tally;
}

TEST(ShaftCases, AFloorLiesUnderItsPointsAndBlocksNothing) {
  for (const int cells : {1, 3, 40}) {
    GroupCase c = floor_case(cells, 32);
    see(c, 32);
    const Tally tally = kinds(c);
    EXPECT_EQ(tally.mixed + tally.dark, 0u) << cells;
    EXPECT_EQ(tally.lit, 16u);
  }
}

// Vertices of a turned and moved floor are rounded: neighbours rise above each other by that much, which the
// contact rule forgives.
TEST(ShaftCases, ATiltedFloorFarFromTheOriginBlocksNothing) {
  GroupCase c = floor_case(2, 32);
  const glm::dmat3 turn(0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6);  // a rotation
  const dvec3 move(1000, -2000, 500);
  for (glm::vec3& v : c.soup.positions) v = glm::vec3(turn * dvec3(v) + move);
  c.light = regular_light(turn * dvec3(0, 4, 0) + move, turn * dvec3(0, -1, 0), 0.5, 4);
  c.view = pinhole(turn * dvec3(0, 3, 0) + move, move, 0.7, 32, 32);
  see(c, 32);
  const Tally tally = kinds(c);
  EXPECT_GT(tally.lit, 10u);
  EXPECT_EQ(tally.mixed + tally.dark, 0u);
}

// A lid over everything; and one of half-width 0.75 halfway to the light: umbra to 1.15, penumbra to 2.
TEST(ShaftCases, ALidDarkensTheGroupsInItsUmbraOnly) {
  GroupCase c = floor_case(1, 64);
  see(c, 64);  // the camera hangs below the lid
  c.soup.add({-12, 2, -12}, {12, 2, -12}, {0, 2, 12});
  const auto lid = static_cast<std::uint32_t>(c.soup.triangles.size() - 1);
  c.view.eye.y = 1.5f;
  ShaftCheck check(c);
  Tally tally;
  check.run(tally, 20);
  EXPECT_EQ(tally.dark, check.all().size());
  for (const Given& g : check.all()) EXPECT_EQ(g.candidates, std::vector<std::uint32_t>{lid});

  c = floor_case(1, 128);
  see(c, 128);
  c.soup.quad({-0.75, 2, -0.75}, {0, 0, 1.5}, {1.5, 0, 0});  // two triangles: none alone darkens the middle
  const Tally halves = kinds(c);
  EXPECT_GT(halves.dark, 0u);
  EXPECT_GT(halves.mixed, 0u);
  EXPECT_GT(halves.lit, 0u);
}

// Just touching the umbra's rim is not dark; the lid's own points are not darkened by it.
TEST(ShaftCases, ALidInContactDarkensNothing) {
  GroupCase c = floor_case(1, 32);
  see(c, 32);
  c.soup.add({-12, 0, -12}, {12, 0, -12}, {0, 0, 12});  // in the floor's plane
  const Tally tally = kinds(c);
  EXPECT_EQ(tally.lit, 16u);
}

TEST(ShaftCases, TrianglesBehindTheLightOrBeyondThePointsAreLeftOut) {
  GroupCase c = floor_case(1, 32);
  see(c, 32);
  c.soup.add({-12, 4.01, -12}, {12, 4.01, -12}, {0, 4.01, 12});
  c.soup.add({-12, -0.01, -12}, {12, -0.01, -12}, {0, -0.01, 12});
  c.soup.add({5, 1, 5}, {6, 2, 5}, {5, 1, 6});
  EXPECT_EQ(kinds(c).lit, 16u);
}

// Points below two sheets that they are said to lie on, in turn: each sheet blocks all lines, but not from
// its own points.
TEST(ShaftCases, AReceiverOfTheGroupDarkensNone) {
  GroupCase c = floor_case(1, 8);
  see(c, 8);
  c.soup = {};
  for (const double y : {0.0, 0.25}) c.soup.add({-12, y, -12}, {0, y, 12}, {12, y, -12});
  for (std::size_t i = 0; i < c.points.positions.size(); ++i) {
    c.points.positions[i].y = -0.5;
    c.points.triangles[i] = i % 2;
  }
  ShaftCheck check(c);
  ASSERT_EQ(check.all().size(), 1u);
  EXPECT_EQ(check.all()[0], (Given{soft::GroupClass::mixed, {0, 1}}));
  Tally tally;
  check.run(tally, 20);
  EXPECT_EQ(tally.blocked, tally.lines);
}

// A cone's faces share a corner and lie behind each other's planes.
TEST(ShaftCases, AConvexBodyDoesNotBlockWhereTheWholeLightIsUp) {
  GroupCase c;
  c.name = "cone";
  const auto rim = [](int k) { return dvec3(2 * std::cos(0.3 * k), 0, -2 * std::sin(0.3 * k)); };
  for (int k = 0; k < 21; ++k) c.soup.add({0.1, 1, 0.2}, rim(k), k < 20 ? rim(k + 1) : rim(0));
  c.light = regular_light({0, 6, 0}, {0, -1, 0}, 0.3, 5);
  c.view = pinhole({0, 5, 0}, {0, 0, 0}, 0.5, 64, 64);
  see(c, 64);
  const Tally tally = kinds(c);
  EXPECT_EQ(tally.mixed + tally.dark, 0u);
  EXPECT_GT(tally.lit, 40u);
}

TEST(ShaftCases, WhatCastsNoShadowIsNoCandidate) {
  GroupCase c = floor_case(1, 32);
  see(c, 32);
  c.soup.add({-12, 2, -12}, {12, 2, -12}, {0, 2, 12});
  c.view.eye.y = 1.5f;
  c.soup.casts = {1, 1, 0};
  EXPECT_EQ(kinds(c).lit, 16u);
}

TEST(ShaftCases, NothingToGroupAndNothingThatCastsAreFine) {
  GroupCase c = floor_case(1, 8);
  c.points = {.width = 8,
              .height = 8,
              .positions = std::vector<dvec3>(64),
              .triangles = std::vector<std::uint32_t>(64, no_triangle)};
  EXPECT_TRUE(given(c, grouped(c)).empty());
  see(c, 8);
  c.soup.casts = {0, 0};
  EXPECT_EQ(kinds(c).lit, 1u);
}

}  // namespace
}  // namespace tenebra::testing
