// Points in the air: every variant says what the sightlines from them say.
#include <gtest/gtest.h>

#include "shadow/mask_case.h"
#include "shadow/rays/sightlines.h"

namespace tenebra::testing {
namespace {

/// Points between the triangles of a room, among points on them.
MaskCase air(std::uint64_t seed, const ShadowLight& light) {
  Random random(seed);
  MaskCase c;
  c.soup = room(random, 6);
  c.light = light;
  c.view = view_from_light(light);
  c.points = points_on_triangles(c.soup, random, 900);
  c.points.seen_from = c.view;
  std::vector<std::int8_t> sides;
  for (std::size_t i = 0; i < c.points.triangles.size(); ++i) {
    const std::uint32_t id = c.points.triangles[i];
    sides.push_back(
        static_cast<std::int8_t>(id == no_triangle ? 0 : visible_side(c.points, c.soup.view(), i)));
  }
  c.points.sides = std::move(sides);
  for (std::size_t i = 0; i < c.points.triangles.size(); ++i) {
    if (i % 3 == 1) continue;
    c.points.triangles[i] = free_point, c.points.sides[i] = 0;
    if (i % 3 == 0) c.points.positions[i] = random.in_cube(0.9);
  }
  c.points.positions[0] = glm::dvec3(light.position);
  return c;
}

TEST(FreePoints, SeeTheLightWhereNothingIsInTheWay) {
  std::size_t lit = 0, dark = 0;
  for (const ShadowLight& light : {point_light({0.2, 0.9, -0.3}), sun({0.3, 1, 0.2}),
                                   ShadowLight{.position = {0.2f, 0.9f, 0.1f}, .spot_cos_outer = 0.8f}}) {
    MaskCase c = air(5, light);
    const TriangleView triangles = c.soup.view();
    ShadowMask expected(c.points.triangles.size(), 0);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (c.points.triangles[i] == no_triangle) continue;
      const shadow::Sample sample{c.points.positions[i], c.points.triangles[i], c.points.sides[i]};
      const bool seen = i == 0 && !light.directional;  // at the light itself nothing lies between
      const auto line = shadow::find_sightlines(sample, triangles, {&light, 1}, c.config).front();
      expected[i] = seen || line.sight == shadow::LightSight::lit ? 255 : 0;
      if (c.points.triangles[i] == free_point) ++(expected[i] != 0 ? lit : dark);
    }
    EXPECT_TRUE(all_variants_give(c, expected));
  }
  EXPECT_GT(lit, 100u);
  EXPECT_GT(dark, 100u);
}

}  // namespace
}  // namespace tenebra::testing
