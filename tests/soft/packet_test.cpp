// Points solved sixteen at a time: near ones that see the same occluders, others, fewer than sixteen, and
// what a packet cannot hold.
#include <gtest/gtest.h>

#include <cmath>

#include "soft/soft_case.h"

namespace tenebra::testing {
namespace {

/// A floor and a ball on it below, `occluders` between, a light above; `width` of view in radians.
SoftCase occluded_square(const std::string& name, const Soup& occluders, double width, int pixels) {
  SoftCase c;
  c.name = name;
  c.soup.quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0});
  c.soup.append(sphere(3, 0.3, {0.3, 0.2, 0.2}));
  c.soup.append(occluders);
  c.light = square_light({0.4, 5, -0.3}, {0, 0, 0}, 2.5);
  c.view = pinhole({0.6, 1.2, 2.5}, {0.2, 0.1, 0.1}, width, pixels, pixels);
  c.points = view_samples(c.soup.view(), c.view, pixels, pixels);
  return c;
}

/// Shading normals that lean away from the triangles', so that their horizons cut the light for some.
void lean_normals(SoftCase& c, Random& random) {
  c.normals.assign(c.size(), glm::vec3(0, 1, 0));
  for (glm::vec3& n : c.normals) n = glm::normalize(glm::vec3(glm::dvec3(0, 1, 0) + random.in_cube(0.75)));
}

// Every kind of triangles, seen from afar (neighbours see different ones) and from near.
TEST(SoftPackets, GiveWhatTheReferenceGives) {
  Random random(61);
  std::size_t between = 0;
  for (const SoupMaker& maker : soup_makers()) {
    const Soup soup = maker.make(random).moved(0.5, {0.2, 1.6, 0});
    for (const double width : {1.2, 0.08}) {
      SoftCase c = occluded_square(maker.name + ", seed 61", soup, width, 28);
      if (width < 1) lean_normals(c, random);
      const SoftMask expected = traced(c, SoftPrecision::reference), mask = traced(c, SoftPrecision::fast);
      const double white = white_of(c, expected);
      for (std::size_t i = 0; i < c.size(); ++i) {
        between += expected.visible_fraction[i] > 0 && expected.visible_fraction[i] < 1;
        EXPECT_NEAR(mask.visible_fraction[i], expected.visible_fraction[i], fast_bound) << describe(c, i);
        EXPECT_NEAR(mask.irradiance[i], expected.irradiance[i], fast_bound * white) << describe(c, i);
      }
    }
  }
  EXPECT_GT(between, 3000u);
}

// A round hole leaves a fragment of more vertices than a packet's polygons can have: its points are solved
// one by one.
TEST(SoftPackets, ARoundHoleIsExact) {
  Soup rim;
  constexpr int edges = 30;
  for (int k = 0; k < edges; ++k) {
    const double angle = 2 * 3.141592653589793 * k / edges;
    const glm::dvec3 out(std::cos(angle), 0, std::sin(angle)), along(-out.z, 0, out.x), up(0.2, 2.5, 0);
    rim.add(up + 0.4 * out - 1.5 * along, up + 0.4 * out + 1.5 * along, up + 4.0 * out);
  }
  Judgement sum;
  judge_all(occluded_square("round hole", rim, 0.9, 12), sum);
  sum.print("round hole");
  EXPECT_GT(sum.penumbra, 60u);
}

}  // namespace
}  // namespace tenebra::testing
