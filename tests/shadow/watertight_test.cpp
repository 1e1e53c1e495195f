// Closed bodies leak nothing, plain surfaces do not shadow themselves, and answers follow what is done to a
// scene.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "shadow/mask_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

TEST(ShadowMask, IsWatertightAtVerticesEdgesAndInside) {
  struct Place {
    double scale;
    dvec3 offset;
  };
  const Place places[] = {{1, dvec3(0)},
                          {1e-6, dvec3(0)},
                          {1e6, dvec3(0)},
                          {1, {1e3, -1e3, 1e3}},
                          {3000, {148376, 1234, -223423}},
                          {3000, {1e6, 1e6, 1e6}}};
  std::uint64_t rays = 0, leaks = 0;
  for (const int rings : {2, 8, 32, 64})
    for (const Place& place : places) {
      const auto seed = static_cast<std::uint64_t>(rings);
      Random random(seed);
      MaskCase c;
      c.name = fmt::format("sphere of {} rings x {} + {}, seed {}", rings, place.scale, place.offset.x, seed);
      c.soup = sphere(rings, 1, dvec3(0));
      c.soup.append(sphere(2, 6, dvec3(0)));  // receives what the inner sphere lets through
      c.soup = c.soup.moved(place.scale, place.offset);
      c.light = point_light(dvec3(0.2, 0.1, -0.3) * place.scale + place.offset);
      c.view = view_from_light(c.light);
      const auto inner = static_cast<std::uint32_t>(12 * rings * rings);
      const VisiblePoints aimed = points_behind_edges(c.soup, c.light, random, 44000);
      c.points = aimed;
      for (std::uint32_t& id : c.points.triangles)
        if (id < inner) id = no_triangle;  // points on the inner sphere itself see the light
      const ShadowMask mask = traced(c);
      for (std::size_t i = 0; i < mask.size(); ++i) {
        rays += c.points.triangles[i] != no_triangle;
        leaks += mask[i] != 0;
      }
      EXPECT_EQ(leaks, 0u) << c.name;
    }
  std::printf("watertight: %llu rays, %llu leaks\n", static_cast<unsigned long long>(rays),
              static_cast<unsigned long long>(leaks));
  EXPECT_GE(rays, 1000000u);
}

/// As pbrt's Reintersect: triangles of every size, each with its halves beside it (split at a rounded
/// midpoint).
TEST(ShadowMask, PlainSurfacesDoNotShadowThemselves) {
  Random random(71);
  std::uint64_t rays = 0;
  for (int i = 0; i < 1000; ++i) {
    const Soup whole = wide_range(random, 1);
    MaskCase c;
    c.name = fmt::format("triangle {}, seed 71", i);
    const dvec3 a(whole.corner(0, 0)), b(whole.corner(0, 1)), d(whole.corner(0, 2)),
        m(glm::vec3(0.5 * (b + d)));
    c.soup.add(a, b, m);
    c.soup.add(a, m, d);
    c.light = point_light(a + glm::length(b - a) * random.direction());
    c.view = view_from_light(c.light);
    c.points = points_on_triangles(c.soup, random, 1000);
    const ShadowMask mask = traced(c), expected = oracle(c);
    ASSERT_TRUE(same_mask(c, mask, expected));
    rays += mask.size();
    Soup own;
    own.add(a, b, d);
    c.soup = own;
    c.points = points_on_triangles(own, random, 1000);
    const oracle::ExactShadow judge(c.view, own.view(), c.light, c.config);
    const ShadowMask alone = traced(c);
    for (std::size_t k = 0; k < alone.size(); ++k)
      ASSERT_EQ(alone[k] != 0, judge.active(c.points.positions[k], c.points.triangles[k]))
          << c.name << " sample " << k;
    rays += alone.size();
  }
  EXPECT_GE(rays, 2000000u);
}

MaskCase metamorphic_case() {
  Random random(81);
  MaskCase c;
  c.name = "room, seed 81";
  c.soup = room(random, 1000);
  c.light = point_light({0.2, 1.6, -0.3});
  c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, 256, 256);
  c.points = view_samples(c.soup.view(), c.view, 256, 256);
  return c;
}

TEST(ShadowMask, CatalogueF_DuplicatesZeroAreasAndFarTrianglesChangeNothing) {
  MaskCase c = metamorphic_case();
  const ShadowMask before = traced(c);
  const auto count = static_cast<std::uint32_t>(c.soup.triangles.size());
  for (std::uint32_t id = 0; id < count; id += 7)
    c.soup.add(c.soup.corner(id, 0), c.soup.corner(id, 0), c.soup.corner(id, 2));
  Random random(82);
  for (int i = 0; i < 100; ++i)
    c.soup.add(dvec3(50) + random.in_cube(5), dvec3(50) + random.in_cube(5), dvec3(50));
  EXPECT_TRUE(all_variants_give(c, before));
}

TEST(ShadowMask, CatalogueF_MirroringAndPermutingAxesChangeNothing) {
  const MaskCase c = metamorphic_case();
  const ShadowMask before = traced(c);
  const auto turned = [&](auto turn) {
    MaskCase t = c;
    for (glm::vec3& p : t.soup.positions) p = glm::vec3(turn(dvec3(p)));
    for (dvec3& p : t.points.positions) p = turn(p);
    t.light.position = glm::vec3(turn(dvec3(c.light.position)));
    t.view.eye = glm::vec3(turn(dvec3(c.view.eye)));
    return t;
  };
  MaskCase mirrored = turned([](dvec3 p) { return dvec3(-p.x, p.y, p.z); });
  EXPECT_TRUE(all_variants_give(mirrored, before));
  MaskCase permuted = turned([](dvec3 p) { return dvec3(p.y, p.z, p.x); });
  // theta is a double: its last bit may move with the order of a sum, so the oracle of the turned scene is
  // asked too
  EXPECT_TRUE(all_variants_give(permuted, oracle(permuted)));
  EXPECT_LE(differences(oracle(permuted), before).size(), 1u);
}

TEST(ShadowMask, CatalogueF_MaskOfAUnionIsTheOrOfTheMasks) {
  MaskCase c = metamorphic_case();
  const ShadowMask whole = traced(c);
  const std::size_t count = c.soup.triangles.size();
  c.soup.casts.assign(count, 0);
  for (std::size_t i = 0; i < count; i += 3) c.soup.casts[i] = 1;
  const ShadowMask some = traced(c);
  for (std::uint8_t& casts : c.soup.casts) casts = casts == 0 ? 1 : 0;
  ShadowMask both = traced(c);
  for (std::size_t i = 0; i < both.size(); ++i) both[i] = std::min(both[i], some[i]);
  EXPECT_TRUE(same_mask(c, whole, both));
}

TEST(ShadowMask, CatalogueF_MaskOfACropIsTheCropOfTheMask) {
  const MaskCase c = metamorphic_case();
  const ShadowMask whole = traced(c);
  MaskCase crop = c;
  crop.points = {};
  crop.points.width = 77, crop.points.height = 91;
  ShadowMask expected;
  for (std::size_t y = 50; y < 141; ++y)
    for (std::size_t x = 33; x < 110; ++x) {
      crop.points.positions.push_back(c.points.positions[y * 256 + x]);
      crop.points.triangles.push_back(c.points.triangles[y * 256 + x]);
      expected.push_back(whole[y * 256 + x]);
    }
  EXPECT_TRUE(all_variants_give(crop, expected));
}

/// A picture of one row: 2^20 + 1 pixels, then wider than 2^21, where tiles along one axis number more than
/// 2^15.
TEST(ShadowMask, CatalogueC_OneVeryLongRow) {
  Random random(91);
  MaskCase c;
  c.soup = room(random, 100);
  c.light = point_light({0.2, 1.6, -0.3});
  c.view = view_from_light(c.light);
  c.points = points_on_triangles(c.soup, random, 1000);
  for (const int width : {(1 << 20) + 1, (1 << 21) + 65}) {
    c.name = fmt::format("a row of {} pixels, seed 91", width);
    c.points.width = width, c.points.height = 1;
    c.points.positions.resize(static_cast<std::size_t>(width), dvec3(0));
    c.points.triangles.resize(static_cast<std::size_t>(width), no_triangle);
    EXPECT_TRUE(exact(c));
  }
}

}  // namespace
}  // namespace tenebra::testing
