// Light that grazes: a hair above a floor that things stand on, where floats can tell next to nothing.

#include <fmt/core.h>

#include "shadow/mask_case.h"

namespace tenebra::testing {
namespace {

/// Boxes on a floor of many quads, looked at from above.
MaskCase floor_case(ShadowLight light, bool tilted) {
  MaskCase c;
  for (int x = -4; x < 4; ++x)
    for (int z = -4; z < 4; ++z) c.soup.quad({x, 0, z + 1}, {1, 0, 0}, {0, 0, -1});
  Random random(91);
  for (int i = 0; i < 24; ++i) {
    const double x = random.in(-3.8, 3.5), z = random.in(-3.8, 3.5);
    c.soup.append(box({x, 0, z}, {x + 0.3, random.in(0.1, 0.6), z + 0.3}));
  }
  // A floor whose corners are rounded: its triangles are not quite one plane.
  if (tilted)
    for (glm::vec3& p : c.soup.positions) p.y += 0.3f * p.x + 0.1f;
  c.light = light;
  c.view = pinhole({3, 4, 5}, {0, 0, 0}, 0.8, 120, 100);
  c.points = view_samples(c.soup.view(), c.view, 120, 100);
  return c;
}

struct GrazingLight {
  const char* name;
  ShadowLight light;
  bool tilted = false, below = false;
};
std::vector<GrazingLight> grazing_lights() {
  return {{"a hair above", point_light({0.1, 1e-18, 0.2})},
          {"the least above", point_light({0.1, 1e-45, 0.2})},
          {"above", point_light({0.1, 1e-9, 0.2})},
          {"far away", point_light({1e15, 1e-18, 1e14})},
          {"below", point_light({0.1, -1e-18, 0.2}), false, true},
          {"from the side", sun({1, 1e-18, 0.3})},
          {"above a slope", point_light({0.5, 0.3 * 0.5 + 0.1 + 3e-8, 0.2}), true},
          {"along a slope", sun({1, 0.3 + 3e-8, 0.25}), true}};
}

TEST(GrazingLight, IsDecidedExactly) {
  for (const GrazingLight& grazing : grazing_lights()) {
    MaskCase c = floor_case(grazing.light, grazing.tilted);
    c.name = grazing.name;
    expect_same_at_levels_and_threads(c, oracle(c));
    c.config.contact = ContactRule::none;
    EXPECT_TRUE(exact(c));
  }
}

// Products of heights are as good as their floats: double decides by them, though by the lengths of edges it
// could not.
TEST(GrazingLight, NeedsNoExactArithmeticOverALevelFloor) {
  for (const GrazingLight& grazing : grazing_lights()) {
    if (grazing.tilted || grazing.below) continue;
    const MaskCase c = floor_case(grazing.light, false);
    ShadowTracer tracer;
    traced(c, tracer);
    const TraceStats& stats = tracer.stats();
    std::printf("%s: %llu rays, beyond float %llu, beyond double %llu\n", grazing.name,
                static_cast<unsigned long long>(stats.rays),
                static_cast<unsigned long long>(stats.float_unknown),
                static_cast<unsigned long long>(stats.double_unknown));
    EXPECT_GT(stats.float_unknown, 1000u) << grazing.name << ": the light is too kind";
    EXPECT_LT(stats.double_unknown, stats.float_unknown / 100) << grazing.name;
  }
}

}  // namespace
}  // namespace tenebra::testing
