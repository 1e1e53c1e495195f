// Every variant against the plainest loop over the library's own exact decision. (The independent oracle is
// in tests/reference.)
#include <gtest/gtest.h>

#include <algorithm>

#include "shadow/decide.h"
#include "shadow/mask.h"
#include "shadow/triangle_planes.h"
#include "support/random.h"

namespace tenebra {
namespace {

using glm::vec3;

constexpr Variant all_variants[] = {Variant::precise,        Variant::precise_sorted, Variant::spheres,
                                    Variant::spheres_sorted, Variant::precise_sea,    Variant::precise_eatp,
                                    Variant::precise_seatp};

struct Soup {
  std::vector<vec3> positions;
  std::vector<glm::uvec3> triangles;
  TriangleView view() const { return {positions, triangles, {}}; }
  void add(vec3 a, vec3 b, vec3 c) {
    const auto i = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), {a, b, c});
    triangles.push_back({i, i + 1, i + 2});
  }
};

Soup random_soup(int count, double size, std::uint64_t seed) {
  test::Random random(seed);
  Soup soup;
  for (int i = 0; i < count; ++i) {
    const vec3 centre = random.vec3(-1, 1);
    soup.add(centre + random.vec3(-size, size), centre + random.vec3(-size, size),
             centre + random.vec3(-size, size));
  }
  return soup;
}

// Samples strewn over the triangles, as if each pixel saw a random point.
VisiblePoints samples_on(const Soup& soup, int width, int height, std::uint64_t seed) {
  test::Random random(seed);
  VisiblePoints points{width, height, {}, {}};
  for (int i = 0; i < width * height; ++i) {
    const auto id = static_cast<std::uint32_t>(random.below(static_cast<int>(soup.triangles.size())));
    const glm::uvec3 t = soup.triangles[id];
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const glm::dvec3 a = soup.positions[t.x], b = soup.positions[t.y], c = soup.positions[t.z];
    points.positions.push_back(a + u * (b - a) + v * (c - a));
    points.triangles.push_back(id);
  }
  return points;
}

ShadowMask plain_mask(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                      const ShadowLight& light) {
  const RaySource source = ray_source(light);
  TriangleSet set;
  build_triangle_set(triangles, view, source, {}, set);
  ShadowMask mask(points.triangles.size(), 0);
  TraceStats stats;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (points.triangles[i] == no_triangle || !set.facing[points.triangles[i]]) continue;
    bool blocked = false;
    for (const TrianglePlanes& t : set.planes) {
      blocked = blocked || decide(t, points.positions[i], points.triangles[i], source, triangles,
                                  ContactRule::triangle_ids, stats);
    }
    mask[i] = blocked ? 0 : 255;
  }
  return mask;
}

struct Case {
  const char* name;
  int triangles;
  double size;
  ShadowLight light;
};

class VariantsAgree : public testing::TestWithParam<Case> {};

TEST_P(VariantsAgree, WithThePlainLoop) {
  const Case& c = GetParam();
  const Soup soup = random_soup(c.triangles, c.size, 11);
  const VisiblePoints points = samples_on(soup, 97, 61, 12);
  const ViewRays view{.eye = {0.3f, 0.2f, 5.0f}};
  const ShadowMask expected = plain_mask(points, view, soup.view(), c.light);
  EXPECT_GT(std::count(expected.begin(), expected.end(), 255), 20);
  EXPECT_GT(std::count(expected.begin(), expected.end(), 0), 20);
  for (const Variant variant : all_variants) {
    for (const SimdLevel simd : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(simd)) continue;
      ShadowTracer tracer;
      ShadowMask mask;
      tracer.trace_shadow_mask(points, view, soup.view(), c.light,
                               {variant, false, ContactRule::triangle_ids, simd}, mask);
      std::size_t differing = 0;
      for (std::size_t i = 0; i < mask.size(); ++i) differing += mask[i] != expected[i];
      EXPECT_EQ(differing, 0u) << variant_name(variant) << ' ' << simd_level_name(simd);
    }
  }
}

ShadowLight point_light(vec3 position) {
  return {.position = position};
}
ShadowLight sun(vec3 to_light) {
  return {.directional = true, .to_light = to_light};
}

INSTANTIATE_TEST_SUITE_P(Soups, VariantsAgree,
                         testing::Values(Case{"light_outside", 300, 0.1, point_light({2, 4, 3})},
                                         Case{"light_inside", 300, 0.2, point_light({0.1f, 0.0f, 0.1f})},
                                         Case{"large_triangles", 20, 1.0, point_light({2, 4, 3})},
                                         Case{"small_triangles", 4000, 0.03, point_light({1, 2, 1})},
                                         Case{"far_light", 300, 0.1, point_light({2e4f, 4e4f, 3e4f})},
                                         Case{"sun", 300, 0.1, sun({2, 4, 3})},
                                         Case{"sun_large", 20, 1.0, sun({0, 1, 0})}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace tenebra
