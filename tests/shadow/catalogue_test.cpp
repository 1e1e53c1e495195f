// Rows A to E of the catalogue of reliability.md that touch triangles, light, view, cones and numbers: a
// hand-made or generated case a row, against the oracle.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "shadow/mask_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

/// Points on all triangles of `soup`, and points behind its edges, for a light; every variant.
void expect_exact(const std::string& name, const Soup& soup, const ShadowLight& light,
                  std::uint64_t seed = 1) {
  Random random(seed);
  MaskCase c;
  c.name = fmt::format("{}, seed {}", name, seed);
  c.soup = soup, c.light = light, c.view = view_from_light(light);
  c.points = points_on_triangles(soup, random, 1000);
  EXPECT_TRUE(all_variants_give(c, oracle(c)));
  c.points = points_behind_edges(soup, light, random, 500);
  EXPECT_TRUE(all_variants_give(c, oracle(c)));
}

const dvec3 up_there{0.3, 3, -0.2};

TEST(ShadowMask, CatalogueA_Slivers) {
  for (const double aspect : {1e3, 1e6, 1e9}) {
    Random random(21);
    expect_exact(fmt::format("aspect {}", aspect), slivers(random, 200, aspect), point_light(up_there));
  }
}

TEST(ShadowMask, CatalogueA_NeedleFanOfTenThousand) {
  Random random(22);
  expect_exact("fan", needle_fan(random, 10000), point_light(up_there));
}

TEST(ShadowMask, CatalogueA_ZeroAreasAndDuplicates) {
  Random random(23);
  expect_exact("zero areas", with_zero_areas(random, 100), point_light(up_there));
  expect_exact("copies", duplicates(random, 3, 1000), point_light(up_there));
}

TEST(ShadowMask, CatalogueA_CoplanarTJunctionsInterpenetrating) {
  Random random(24);
  expect_exact("coplanar", coplanar(random, 100), point_light(up_there));
  expect_exact("wall", tilted_wall(random), point_light(up_there));
  expect_exact("interpenetrating", interpenetrating(random, 100), point_light(up_there));
}

// A needle's plane is so uncertain that a point computed on it may lie behind it by more than any tolerance:
// what counts is that its own triangle never blocks it, neither ray by ray nor by early accept.
TEST(ShadowMask, OwnTriangleNeverBlocksAPointBehindIt) {
  Random random(27);
  MaskCase c;
  c.light = point_light(up_there);
  c.view = view_from_light(c.light);
  c.soup.add({-2, 0, -2}, {0, 0, 3}, {2, 0, -2});
  c.soup.add({-0.5, -0.5, -0.5}, {0, -0.5, 0.5}, {0.5, -0.5, -0.5});
  for (const double depth : {1e-6, 1e-3, 0.1}) {
    c.name = fmt::format("{} behind the own triangle, seed 27", depth);
    c.points = points_on_triangles(c.soup, random, 1000);
    for (dvec3& p : c.points.positions) p.y -= depth;
    const ShadowMask expected = oracle(c);
    EXPECT_GT(std::count(expected.begin(), expected.end(), 255), 300);
    EXPECT_GT(std::count(expected.begin(), expected.end(), 0), 300);
    EXPECT_TRUE(all_variants_give(c, expected));
  }
}

TEST(ShadowMask, CatalogueA_HugeTriangleAndTinyCluster) {
  Random random(25);
  Soup soup = room(random, 100);
  soup.add({-1e6, -1.5, -1e6}, {1e6, -1.5, -1e6}, {0, -1.5, 2e6});
  soup.add({-1e6, 2.5, -1e6}, {1e6, 2.7, -1e6}, {0, 2.6, 2e6});
  expect_exact("huge", soup, point_light({0.1, 1.5, 0.2}));
  expect_exact("tiny", tiny_cluster(random, 20000), point_light(up_there));
  expect_exact("equal centroids", equal_centroids(random, 300), point_light(up_there));
}

TEST(ShadowMask, CatalogueB_LightOnAPlane) {
  Random random(31);
  Soup soup = room(random, 100);
  soup.add({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  for (const float y : {0.0f, std::nextafterf(0, 1), std::nextafterf(0, -1), 1e-7f, -1e-7f})
    expect_exact(fmt::format("y = {:a}", y), soup, point_light({1.5, y, 0.7}));
  for (const float y : {2.0f, std::nextafterf(2, 3), std::nextafterf(2, 1)})  // in the ceiling
    expect_exact(fmt::format("y = {:a}", y), soup, point_light({0.5, y, 0.7}));
}

TEST(ShadowMask, CatalogueB_LightOnAnEdge) {
  Random random(32);
  const Soup soup = room(random, 100);
  expect_exact("edge of the room", soup, point_light({2, 0.5, 2}));
  expect_exact("diagonal of the floor", soup, point_light({0.5, -1, 0.5}));
}

TEST(ShadowMask, CatalogueB_LightOnAVertex) {
  Random random(33);
  const Soup soup = room(random, 100);
  for (const std::uint32_t id : {0u, 12u, 500u})
    expect_exact("vertex", soup, point_light(dvec3(soup.corner(id, 0))));
}

TEST(ShadowMask, CatalogueB_LightInsideATriangleAndInsideABody) {
  Random random(34);
  Soup soup = room(random, 100);
  soup.add({-1, 1, -1}, {1, 1, -1}, {0, 1, 1});
  expect_exact("inside a triangle", soup, point_light({0, 1, 0}));
  expect_exact("inside the sphere", soup, point_light({0.5, -0.2, 0.3}));
}

TEST(ShadowMask, CatalogueB_LightAtTheCameraLightsAllThatIsSeen) {
  Random random(35);
  MaskCase c;
  c.name = "light at the camera, seed 35";
  c.soup = sphere(16, 1, dvec3(0));
  c.soup.quad({-3, -2, -3}, {0, 0, 6}, {6, 0, 0});
  c.view = pinhole({1.5, 2, 2.5}, {0, 0, 0}, 0.8, 256, 256);
  c.light = point_light(dvec3(c.view.eye));
  c.points = view_samples(c.soup.view(), c.view, 256, 256);
  EXPECT_TRUE(all_variants_give(c, oracle(c)));
}

TEST(ShadowMask, CatalogueB_LightAtASample) {
  MaskCase c;
  c.name = "light at a sample";
  c.soup.add({-1, 0, -1}, {0, 0, 2}, {2, 0, -1});
  c.soup.add({-1, 1, -1}, {0, 1.5, 2}, {2, 1, -1});
  c.light = point_light({0.25, 0.5, 0.25});
  c.view = view_from_light(c.light);
  c.points.positions = {{0.25, 0.5, 0.25}, {0.25, 0, 0.25}, {0.25, 0.5, std::nextafter(0.25, 1)}};
  c.points.triangles = {0, 0, 0};
  c.points.width = 3, c.points.height = 1;
  EXPECT_TRUE(all_variants_give(c, oracle(c)));
  EXPECT_TRUE(all_variants_give(c, {255, 255, 255}));
}

TEST(ShadowMask, CatalogueB_LightFromNearToFar) {
  Random random(36);
  const Soup soup = room(random, 200);
  for (const double distance : {1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6, 1e9})
    expect_exact(fmt::format("distance {}", distance), soup,
                 point_light(dvec3(0, -1, 0) + distance * random.direction()));
}

TEST(ShadowMask, CatalogueB_NonFiniteLightsNeitherCrashNorLight) {
  Random random(37);
  MaskCase c;
  c.soup = room(random, 20);
  c.points = points_on_triangles(c.soup, random, 500);
  for (const float bad : {HUGE_VALF, -HUGE_VALF, std::numeric_limits<float>::quiet_NaN()})
    for (const bool directional : {false, true}) {
      c.light.directional = directional;
      c.light.position = c.light.to_light = {0, bad, 0};
      c.view = view_from_light(c.light);
      c.view.eye = c.view.d0 = {0, 1, 0};
      EXPECT_EQ(traced(c).size(), c.points.triangles.size());
    }
}

TEST(ShadowMask, CatalogueC_SizesOfTheView) {
  Random random(41);
  MaskCase c;
  c.soup = room(random, 300);
  c.light = point_light({0.2, 1.6, -0.3});
  for (const auto& [w, h] :
       {std::pair{1, 1}, {1, 257}, {511, 1}, {63, 65}, {65, 63}, {64, 64}, {33, 31}, {0, 0}}) {
    c.name = fmt::format("{} x {}, seed 41", w, h);
    c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, std::max(w, 1), std::max(h, 1));
    c.points = {};
    if (w > 0) c.points = view_samples(c.soup.view(), c.view, w, h);
    EXPECT_TRUE(all_variants_give(c, oracle(c)));
  }
}

TEST(ShadowMask, CatalogueC_FieldsOfViewEyesInsideAndUpParallel) {
  Random random(42);
  MaskCase c;
  c.soup = room(random, 300);
  c.light = point_light({0.2, 1.6, -0.3});
  for (const double tangent : {8.7e-6, 1.0, 1145.9})  // 0.001, 90 and 179.9 degrees
    for (const dvec3 eye : {dvec3(0.5, -0.2, 0.3), dvec3(0, 1.9, 0), dvec3(9, 9, 9)}) {
      c.name = fmt::format("tangent {}, eye {} {} {}, seed 42", tangent, eye.x, eye.y, eye.z);
      c.view = pinhole(eye, {0, -1, 0}, tangent, 64, 64);
      c.points = view_samples(c.soup.view(), c.view, 64, 64);
      EXPECT_TRUE(exact(c));
    }
}

TEST(ShadowMask, CatalogueC_NoVisibleSampleAndOneVisibleSample) {
  MaskCase c;
  c.soup.add({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  c.light = point_light({0, 1, 0});
  c.view = view_from_light(c.light);
  c.points.width = c.points.height = 70;
  c.points.positions.assign(4900, dvec3(NAN));
  c.points.triangles.assign(4900, no_triangle);
  EXPECT_TRUE(all_variants_give(c, ShadowMask(4900, 0)));
  c.points.positions[4000] = {0.25, 0, 0.25}, c.points.triangles[4000] = 0;
  ShadowMask one(4900, 0);
  one[4000] = 255;
  EXPECT_TRUE(all_variants_give(c, one));
}

TEST(ShadowMask, CatalogueD_ConesFromNarrowToAllAround) {
  Random random(51);
  Soup soup = sphere(16, 3, dvec3(0));
  soup.append(random_soup(random, 500, 0.15));
  for (const double cosine : {0.9999, 0.7, 0.0, -0.7, -0.9999, -1.0}) {  // half-angles up to 180 degrees
    MaskCase c;
    c.name = fmt::format("cosine {}, seed 51", cosine);
    c.soup = soup;
    c.light = point_light(random.in_cube(0.2));
    c.light.spot_axis = glm::vec3(random.direction());
    c.light.spot_cos_outer = static_cast<float>(cosine);
    c.view = view_from_light(c.light);
    c.points = points_on_triangles(soup, random, 4000);
    EXPECT_TRUE(all_variants_give(c, oracle(c)));
  }
}

TEST(ShadowMask, CatalogueD_NumbersOfSamples) {
  Random random(52);
  MaskCase c;
  c.soup = room(random, 300);
  c.light = point_light({0.2, 1.6, -0.3});
  c.view = view_from_light(c.light);
  for (const int count : {1, 2, 3, 31, 32, 33, 1024}) {
    c.name = fmt::format("{} samples, seed 52", count);
    c.points = points_on_triangles(c.soup, random, count);
    EXPECT_TRUE(all_variants_give(c, oracle(c)));
  }
  c.name = "2^20 + 1 samples, seed 52";
  c.points = points_on_triangles(c.soup, random, (1 << 20) + 1);
  EXPECT_TRUE(exact(c));
}

TEST(ShadowMask, CatalogueD_EqualAndAntipodalSamples) {
  MaskCase c;
  c.soup = sphere(4, 2, dvec3(0));
  c.soup.add({-0.1, 1, -0.1}, {0.2, 1, 0}, {0, 1, 0.3});
  c.light = point_light(dvec3(0));
  c.view = view_from_light(c.light);
  Random random(53);
  for (int i = 0; i < 1024; ++i) {
    const auto id = i % 3 == 0 ? 0u : random.index(192);
    const dvec3 p =
        (dvec3(c.soup.corner(id, 0)) + dvec3(c.soup.corner(id, 1)) + dvec3(c.soup.corner(id, 2))) / 3.0;
    c.points.positions.push_back(p), c.points.triangles.push_back(id);
  }
  c.points.width = c.points.height = 32;
  c.name = "a third of the samples equal, the rest all around, seed 53";
  EXPECT_TRUE(all_variants_give(c, oracle(c)));
}

TEST(ShadowMask, CatalogueD_OccludersThatCoverTouchOrLieBehindTheLight) {
  Soup soup;
  soup.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});              // receiver
  soup.add({-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5});  // its two halves cover the receiver exactly:
  soup.add({-0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5});  // the light at height 2 sees edges meet corners
  soup.quad({-1, 3, -1}, {0, 0, 2}, {2, 0, 0});              // behind the light
  expect_exact("covered", soup, point_light({0, 2, 0}));
  MaskCase c;
  c.soup = soup, c.light = point_light({0, 2, 0}), c.view = view_from_light(c.light);
  c.points.positions = {{-1, 0, -1}, {1, 0, 1},   {-1, 0, 1},
                        {0, 0, 0},   {0.3, 0, 1}, {std::nextafter(1, 2), 0, 0}};
  c.points.triangles = {0, 0, 1, 0, 0, 0};
  c.points.width = 6, c.points.height = 1;
  EXPECT_TRUE(all_variants_give(c, {0, 0, 0, 0, 0, 255}));
}

TEST(ShadowMask, CatalogueD_DepthRangeOfFifteenOrdersInOneNode) {
  Random random(54);
  Soup soup;
  for (int i = 0; i < 200; ++i) {
    const double size = std::pow(10.0, random.in(-6, 9));
    const dvec3 p = size * glm::normalize(dvec3(1, 1, 1) + random.in_cube(0.05));
    soup.add(p + 0.02 * size * random.in_cube(1), p + 0.02 * size * random.in_cube(1),
             p + 0.02 * size * random.in_cube(1));
  }
  expect_exact("depths", soup, point_light(dvec3(0)), 54);
}

TEST(ShadowMask, CatalogueE_PowersOfTwoGiveEqualBits) {
  Random random(61);
  MaskCase c;
  c.soup = room(random, 300);
  c.light = point_light({0.2, 1.6, -0.3});
  c.view = view_from_light(c.light);
  c.points = points_on_triangles(c.soup, random, 3000);
  const ShadowMask expected = oracle(c);
  for (int k = -40; k <= 40; ++k) {
    MaskCase scaled = c;
    scaled.name = fmt::format("x 2^{}, seed 61", k);
    scaled.soup = c.soup.moved(std::ldexp(1, k), dvec3(0));
    scaled.light.position = glm::vec3(dvec3(c.light.position) * std::ldexp(1, k));
    scaled.view = view_from_light(scaled.light);
    for (dvec3& p : scaled.points.positions) p *= std::ldexp(1, k);
    EXPECT_TRUE(same_mask(scaled, traced(scaled), expected));
  }
}

TEST(ShadowMask, CatalogueE_DenormalsAndLargestNumbers) {
  Random random(62);
  for (const double scale : {0x1p-149, 0x1p-140, 0x1p-120, 1e17, 0x1p100, 0x1p120}) {
    MaskCase c;
    c.name = fmt::format("scale {:a}, seed 62", scale);
    c.soup = random_soup(random, 100, 0.5).moved(scale, dvec3(0));
    c.light = point_light(dvec3(1, 2, 1) * scale);
    c.view = view_from_light(c.light);
    c.points = points_on_triangles(c.soup, random, 1000);
    EXPECT_TRUE(all_variants_give(c, oracle(c)));
  }
}

TEST(ShadowMask, CatalogueE_NonFiniteTrianglesLeaveTheOthersAlone) {
  Random random(63);
  MaskCase c;
  c.name = "non-finite, seed 63";
  c.soup = room(random, 100);
  c.light = point_light({0.2, 1.6, -0.3});
  c.view = view_from_light(c.light);
  c.points = points_on_triangles(c.soup, random, 3000);
  const ShadowMask expected = oracle(c);
  for (const double bad : {HUGE_VAL, -HUGE_VAL, double(NAN)}) {
    c.soup.add({0, bad, 0}, {1, 0, 0}, {0, 0, 1});
    c.soup.add({bad, bad, bad}, {bad, bad, bad}, {bad, bad, bad});
  }
  EXPECT_TRUE(all_variants_give(c, expected));
}

}  // namespace
}  // namespace tenebra::testing
