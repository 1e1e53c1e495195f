// Pairs of triangles as one occluder: which are made, and that their shadow is that of both.
#include "soft/occluders/quads.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "soft/light/light_frame.h"
#include "soft/soft_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec2;
using glm::dvec3;

soft::GroupFrame group_at_origin(double half) {
  soft::GroupFrame group;
  group.half = {half, half, half};
  return group;
}

AreaLight light_above() {
  return square_light({0.3, 6, -0.2}, {0, 0, 0}, 2.0);
}

struct Paired {
  soft::GroupCandidates candidates;
  std::vector<std::uint32_t> places;
};

Paired paired(const Soup& soup, const soft::GroupFrame& group) {
  Paired p;
  std::vector<std::uint32_t> ids(soup.triangles.size());
  std::iota(ids.begin(), ids.end(), 0u);
  soft::find_candidates_kernel(SimdLevel::automatic)(soft::light_frame(light_above()), soup.view(), group,
                                                     ids, p.candidates, nullptr);
  p.places.resize(p.candidates.all.size());
  std::iota(p.places.begin(), p.places.end(), 0u);
  soft::pair_triangles(group, p.candidates, p.places);
  return p;
}

/// a, b, c and a, c, d.
Soup two_triangles(dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
  Soup soup;
  soup.add(a, b, c);
  soup.add(a, c, d);
  return soup;
}

TEST(SoftQuads, ARectangleIsOneOccluder) {
  for (const bool turned : {false, true}) {
    const dvec3 corners[4] = {{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}};
    const Soup soup = turned ? two_triangles(corners[3], corners[2], corners[1], corners[0])
                             : two_triangles(corners[0], corners[1], corners[2], corners[3]);
    const Paired p = paired(soup, group_at_origin(0.2));
    ASSERT_EQ(p.candidates.all.size(), 2u);
    ASSERT_EQ(p.places.size(), 1u);
    EXPECT_TRUE(p.candidates.all[p.places[0]].is_quad);
  }
}

TEST(SoftQuads, WhatIsNotConvexOrNotSeenFromOneSideStaysTwo) {
  const dvec3 a(-1, 2, -1), c(1, 2, 1), d(-1, 2, 1);
  const soft::GroupFrame group = group_at_origin(0.2);
  EXPECT_EQ(paired(two_triangles(a, {0.9, 2, -0.8}, c, {0.2, 2, -0.7}), group).places.size(), 2u) << "a fold";
  EXPECT_EQ(paired(two_triangles(a, {0.2, 2, -0.7}, {0.8, 2, 0.9}, {-3, 2, -2.6}), group).places.size(), 2u)
      << "an arrow head";
  EXPECT_EQ(paired(two_triangles(a, {1, 2, -1}, c, d), group_at_origin(2.5)).places.size(), 2u)
      << "points on both sides";
  Soup apart = two_triangles(a, {1, 2, -1}, c, d);
  apart.positions[apart.triangles[1].x].x += 1e-4f;
  EXPECT_EQ(paired(apart, group).places.size(), 2u) << "corners a little apart";
}

/// Whether the line from p to q passes through a triangle, by signed volumes.
bool passes(const Soup& soup, std::uint32_t id, dvec3 p, dvec3 q, bool& sure) {
  const auto volume = [&](dvec3 a, dvec3 b) {
    const double v = glm::dot(glm::cross(a - p, b - p), q - p);
    sure &= std::abs(v) > 1e-9 * glm::length(a - p) * glm::length(b - p) * glm::length(q - p);
    return v;
  };
  const dvec3 a(soup.corner(id, 0)), b(soup.corner(id, 1)), c(soup.corner(id, 2));
  const double x = volume(a, b), y = volume(b, c), z = volume(c, a);
  return (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
}

/// The same for the lines of an occluder, which are positive in its shadow.
bool in_shadow(const soft::Candidate& c, dvec3 p, dvec3 q, bool& sure) {
  bool inside = true;
  for (int k = 0; k < 4; ++k) {
    const auto at = [&](int i) { return dvec3(c.corners[i][0], c.corners[i][1], c.corners[i][2]) - p; };
    const dvec3 from = at(k), to = at((k + 1) % 4);
    if (from == to) continue;  // of a triangle
    const double v = c.sign * glm::dot(glm::cross(from, to - from), q - p);
    sure &= std::abs(v) > 1e-9 * glm::length(from) * glm::length(to - from) * glm::length(q - p);
    inside &= v > 0;
  }
  return inside;
}

// Bent, concave, thin and twisted pairs: where one occluder is made of two, it covers what they cover.
TEST(SoftQuads, ShadeWhatTheirTrianglesShade) {
  Random random(91);
  std::size_t pairs = 0, refused = 0, compared = 0, covered = 0;
  const soft::LightFrame light = soft::light_frame(light_above());
  for (int round = 0; round < 3000; ++round) {
    const dvec3 middle(random.in(-0.5, 0.5), random.in(2.5, 3.5), random.in(-0.5, 0.5));
    const auto corner = [&](double x, double z) {
      return middle + dvec3(x, 0, z) + random.in(0, 2) * random.in_cube(1);
    };
    const Soup soup = two_triangles(corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1));
    const soft::GroupFrame group = group_at_origin(random.chance(0.3) ? 0.05 : 0.9);
    const Paired p = paired(soup, group);
    if (p.candidates.all.size() != 2 || p.places.size() == 2) {
      ++refused;
      continue;
    }
    ++pairs;
    for (int k = 0; k < 40; ++k) {
      const dvec3 from = group.half * random.in_cube(1);
      const dvec2 uv(random.in(-4, 4), random.in(-4, 4));
      const dvec3 to = light.point(uv);
      bool sure = true;
      const bool blocked = passes(soup, 0, from, to, sure) || passes(soup, 1, from, to, sure);
      const soft::LightAxes& axes = p.candidates.axes;
      const bool shaded = in_shadow(p.candidates.all[p.places[0]], axes.of(from), axes.of(to), sure);
      if (!sure) continue;
      EXPECT_EQ(shaded, blocked) << "round " << round << ", from " << from.x << " " << from.y << " "
                                 << from.z;
      ++compared;
      covered += blocked;
    }
  }
  EXPECT_GT(pairs, 300u);
  EXPECT_GT(refused, 300u);
  EXPECT_GT(compared, 10000u);
  EXPECT_GT(covered, 2000u);
}

}  // namespace
}  // namespace tenebra::testing
