// Rows A, B and E of the catalogue of reliability.md for lights and occluders: generated and hand-made cases,
// every point against the oracle, in both precisions and by both solvers.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cfenv>
#include <limits>

#include "soft/random_place.h"
#include "soft/soft_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;

/// Points on all triangles and points behind edges, for a light.
void expect_exact(const std::string& name, const Soup& soup, const AreaLight& light, Judgement& sum,
                  std::uint64_t seed, int count = 36) {
  Random random(seed);
  SoftCase c;
  c.name = fmt::format("{}, seed {}", name, seed);
  c.soup = soup, c.light = light;
  c.view.eye = vec3(light.centre);
  c.points = points_on_triangles(soup, random, count / 2);
  judge_all(c, sum);
  place_in_penumbra(c, random, count);
  c.name += ", behind edges";
  judge_all(c, sum);
}

AreaLight above(double size = 0.5) {
  return square_light({0.3, 3, -0.2}, {0, 0, 0}, size);
}

/// A rectangle, a disc or a polygon of any number of corners, in or about the box of the soup.
AreaLight random_light(Random& random, const Soup& soup) {
  for (;;) {
    const auto [x, y, centre] = random_place(random, soup);
    if (random.chance(0.5)) {
      if (const auto light = make_rectangle_light(centre, vec3(x), vec3(y))) return *light;
      continue;
    }
    std::vector<vec3> corners;
    const int count = 3 + static_cast<int>(random.index(12));
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * 3.14159265358979 * (k + random.in(0.2, 0.8)) / count;
      corners.emplace_back(dvec3(centre) + std::cos(angle) * x + std::sin(angle) * y);
    }
    if (const auto light = make_area_light(corners)) return *light;
  }
}

TEST(SoftCatalogue, A_GeneratedTrianglesOfEveryKind) {
  for (const SoupMaker& maker : soup_makers()) {
    Judgement sum;
    for (int k = 0; k < scaled(3); ++k) {
      const std::uint64_t seed = 100 + static_cast<std::uint64_t>(k);
      Random random(seed);
      const Soup soup = maker.make(random);
      expect_exact(maker.name, soup, random_light(random, soup), sum, seed);
    }
    sum.print(maker.name);
  }
}

TEST(SoftCatalogue, A_HugeTrianglesAndThousandCopies) {
  Judgement sum;
  Random random(1);
  Soup soup = room(random, 40);
  soup.add({-1e6, -1.5, -1e6}, {1e6, -1.5, -1e6}, {0, -1.5, 2e6});
  soup.add({-1e6, 2.5, -1e6}, {1e6, 2.7, -1e6}, {0, 2.6, 2e6});
  expect_exact("huge", soup, square_light({0.1, 1.5, 0.2}, {0, 0, 0}, 0.3), sum, 1);
  Soup copies = duplicates(random, 2, 150);
  copies.quad({-3, -1.5, -3}, {0, 0, 6}, {6, 0, 0});
  expect_exact("copies", copies, above(), sum, 2);
  expect_exact("tiny", tiny_cluster(random, 1500), above(), sum, 3);
  sum.print("huge, copies, tiny");
}

TEST(SoftCatalogue, A_EdgesThatMeetOtherEdgesExactly) {
  Judgement sum;
  // Panes on a grid: collinear edges, shared corners and T-junctions, all in exact floats.
  Random random(2);
  Soup soup;
  soup.quad({-4, -1, -4}, {0, 0, 8}, {8, 0, 0});
  for (int i = 0; i < 40; ++i) {
    const dvec3 corner(glm::ivec3(random.in_cube(3)));
    const dvec3 u = random.chance(0.5) ? dvec3(1, 0, 0) : dvec3(0, 0, 1);
    soup.quad({corner.x, 0.25 * random.index(3), corner.z}, u,
              random.chance(0.5) ? dvec3(0, 1, 0) : dvec3(u.z, u.y, u.x));
  }
  expect_exact("grid", soup, must(make_rectangle_light({0, 3, 0}, {0.5f, 0, 0}, {0, 0, 0.5f})), sum, 3, 196);
  sum.print("grid");
}

// Plates that lie on a ground within and beyond the rounding of both (theta: 1e-7 times 2 x 4 coordinates),
// walls that stand on it, and points beside them at such distances.
TEST(SoftCatalogue, A_ContactsWithinTheRounding) {
  Judgement sum;
  SoftCase c;
  c.name = "contacts, seed 4";
  c.light = above(2);
  c.soup.quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  const double tau = std::sqrt(3.0) * 0x1p-24 * 8;
  Random random(4);
  for (int i = 0; i < 24; ++i) {
    const double x = -3.5 + i % 6, z = -3 + 2 * (i / 6), gap = tau * std::exp2(random.in(-3, 3));
    if (i % 2 == 0)
      c.soup.quad({x, gap, z}, {0, 0, 0.75}, {0.75, 0, 0});
    else
      c.soup.quad({x, -0.25, z}, {0, 1.25, 0}, {0.25, 0, 0.5});
    for (int k = 0; k < 6; ++k) {
      const double off = random.chance(0.5) ? tau * random.in(-3, 3) : random.in(-0.2, 0.2);
      const double s = random.in(0, 0.6);
      c.points.positions.push_back(i % 2 == 0 ? dvec3(x + s, 0, z + s)
                                              : dvec3(x + 0.25 * s + off, 0, z + 0.5 * s - 0.5 * off));
      c.points.triangles.push_back(c.points.positions.back().x < c.points.positions.back().z ? 0 : 1);
    }
  }
  c.points.width = 12, c.points.height = 12;
  c.view.eye = vec3(c.light.centre);
  judge_all(c, sum);
  sum.print("contacts");
}

// Whole groups of points below one plate: theirs is one decision, by the rounding of both triangles.
TEST(SoftCatalogue, A_PlatesOverWholeGroups) {
  Judgement sum;
  const double theta = 2 * std::sqrt(3.0) * 0x1p-24 * 4;
  for (const double factor : {0.3, 0.6, 0.9, 0.99, 1.01, 1.1, 2.0, 1e3}) {
    SoftCase c;
    c.name = fmt::format("plate {} theta above the ground", factor);
    c.light = above(2);
    c.soup.quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
    c.soup.add({-4, factor * theta, -4}, {-4, factor * theta, 4}, {4, factor * theta, 4});
    c.view.eye = vec3(c.light.centre);
    c.points.width = 16, c.points.height = 8;
    for (int k = 0; k < 128; ++k) {
      c.points.positions.emplace_back(-3 + 0.03 * (k % 16), 0, 2 + 0.03 * (k / 16));
      c.points.triangles.push_back(0);
    }
    judge_all(c, sum);
    for (const float f : traced(c, SoftPrecision::fast).visible_fraction)
      ASSERT_EQ(f, factor < 1 ? 1.0f : 0.0f) << c.name;
  }
  sum.print("plates over whole groups");
}

// A point that its maker put off its triangle, even far behind it: its own triangle never blocks it, others
// do.
TEST(SoftCatalogue, A_OwnTrianglesNeverBlock) {
  Judgement sum;
  Random random(27);
  SoftCase c;
  c.light = above(1);
  c.view.eye = vec3(c.light.centre);
  c.soup.add({-2, 0, -2}, {0, 0, 3}, {2, 0, -2});
  c.soup.add({-0.5, -0.5, -0.5}, {0, -0.5, 0.5}, {0.5, -0.5, -0.5});
  for (const double depth : {1e-6, 1e-3, 0.1}) {
    c.name = fmt::format("{} behind the own triangle, seed 27", depth);
    c.points = points_on_triangles(c.soup, random, 144);
    for (dvec3& p : c.points.positions) p.y -= depth;
    judge_all(c, sum);
    // The same with whole groups on one triangle.
    std::sort(c.points.triangles.begin(), c.points.triangles.end());
    judge_all(c, sum);
  }
  sum.print("points behind their own triangles");
}

TEST(SoftCatalogue, B_LightsThatTouchAndCutTheGeometry) {
  Judgement sum;
  Random random(3);
  const Soup soup = room(random, 40);
  const vec3 h{0.25f, 0, 0}, v{0, 0, 0.25f};
  // In the ceiling's plane, an ulp above and below; half sunk into the floor; with a corner at a corner of
  // the room, along an edge of it; inside the closed sphere; around it.
  expect_exact("in a plane", soup, must(make_rectangle_light({0, 2, 0}, h, v)), sum, 4);
  expect_exact("below a plane", soup, must(make_rectangle_light({0, std::nextafter(2.0f, 0.0f), 0}, h, v)),
               sum, 5);
  expect_exact("beyond a plane", soup, must(make_rectangle_light({0, std::nextafter(2.0f, 3.0f), 0}, h, v)),
               sum, 6);
  expect_exact("sunk", soup, must(make_rectangle_light({0, -1, 0}, {0.25f, 0, 0}, {0, 0.25f, 0})), sum, 7);
  expect_exact("at a corner", soup, must(make_rectangle_light({1.75f, 1.5f, 1.75f}, h, v)), sum, 8);
  expect_exact("along an edge", soup, must(make_rectangle_light({1.75f, 2, 0}, h, v)), sum, 9);
  expect_exact("inside a body", soup, square_light({0.5, -0.2, 0.3}, {0, -1, 0}, 0.1), sum, 10);
  expect_exact("around a body", soup, square_light({0.5, -0.2, 0.3}, {0.5, -1, 0.3}, 2), sum, 11);
  sum.print("touching lights");
}

// A light that is a surface of the scene: its own triangles lie in its plane and do not hide it.
TEST(SoftCatalogue, B_LightThatIsAQuadOfTheScene) {
  Judgement sum;
  Soup soup;
  soup.quad({-4, -1, -4}, {0, 0, 8}, {8, 0, 0});
  soup.quad({-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1});
  soup.append(box({-0.3, 0, -0.2}, {0.1, 0.3, 0.4}));
  const auto light =
      make_area_light(std::vector<vec3>{{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}});
  ASSERT_TRUE(light) << light.error().message;
  expect_exact("its own quad", soup, *light, sum, 12);
  sum.print("its own quad");
  SoftCase c;
  c.name = "its own quad, from the floor", c.soup = soup, c.light = *light, c.view.eye = {0, 0.9f, 0};
  c.points.width = c.points.height = 1, c.points.positions = {{3, -1, 3}}, c.points.triangles = {0};
  EXPECT_EQ(traced(c, SoftPrecision::reference).visible_fraction[0], 1.0f);
  EXPECT_EQ(traced(c, SoftPrecision::fast).visible_fraction[0], 1.0f);
}

TEST(SoftCatalogue, B_SamplesAtTheLight) {
  // Points in the light's plane, on the light, an ulp in front of it, and behind it.
  Judgement sum;
  SoftCase c;
  c.name = "samples at the light";
  c.soup.quad({-4, -1, -4}, {0, 0, 8}, {8, 0, 0});
  c.soup.quad({-0.5, -1.5, 0}, {0, 3, 0}, {0, 0, 1});
  c.light = must(make_rectangle_light({0, 1, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}));
  ASSERT_LT(c.light.normal.y, 0);
  c.view.eye = {-2, 0, 0.3f};
  for (const double y : {1.0, std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0), 1 - 1e-12, 1 - 1e-9,
                         1 - 1e-6, 1 - 1e-3, 1.5, 0.0})
    for (const double x : {-0.5, 0.25, -0.75}) {
      c.points.positions.emplace_back(x, y, 0.25);
      c.points.triangles.push_back(2);
    }
  c.points.width = static_cast<int>(c.points.positions.size()), c.points.height = 1;
  judge_all(c, sum);
  sum.print("samples at the light");
}

TEST(SoftCatalogue, B_DistancesAndSizesOfEveryOrder) {
  Judgement sum;
  Random random(5);
  const Soup soup = room(random, 20);
  for (int k = -6; k <= 9; k += 3) {
    const double distance = std::pow(10.0, k);
    // Small as seen from the scene, and large.
    for (const double ratio : {1e-2, 0.5})
      expect_exact(fmt::format("light at 1e{} of size {}", k, ratio), soup,
                   square_light(distance * dvec3(0.3, 0.9, 0.2), {0, 0, 0}, ratio * distance), sum, 13, 24);
  }
  for (const float size :
       {1e-10f, 1e-9f, 1e-8f, 1e-6f, 1e-3f, 1e3f})  // at the origin floats reach that far down
    expect_exact(fmt::format("light of {}", size), soup,
                 must(make_rectangle_light(vec3(0), {size, 0, 0}, {0, 0, size})), sum, 14, 24);
  expect_exact("a line of light", soup, must(make_rectangle_light({0, 1, 0}, {1, 0, 0}, {0, 0, 1e-4f})), sum,
               15, 25);
  sum.print("distances and sizes");
}

/// The same case moved and scaled; points follow in double.
SoftCase moved(const SoftCase& c, double scale, dvec3 offset) {
  SoftCase out = c;
  out.soup = c.soup.moved(scale, offset);
  std::vector<vec3> corners;
  for (const vec3& v : c.light.vertices) corners.emplace_back(dvec3(v) * scale + offset);
  out.light = must(make_area_light(corners));
  out.view.eye = vec3(dvec3(c.view.eye) * scale + offset);
  for (dvec3& p : out.points.positions) p = p * scale + offset;
  return out;
}

SoftCase small_room(std::uint64_t seed, int count) {
  Random random(seed);
  SoftCase c;
  c.soup = room(random, 40);
  c.light = square_light({0.3, 1.7, -0.4}, {0, 0, 0}, 0.4);
  place_in_penumbra(c, random, count);
  return c;
}

TEST(SoftCatalogue, E_PowersOfTwoKeepTheBits) {
  for (const SoftSolver solver : {SoftSolver::automatic, SoftSolver::bsp, SoftSolver::clip})
    for (const SoftPrecision precision : {SoftPrecision::reference, SoftPrecision::fast}) {
      SoftCase c = small_room(20, 400);
      c.config.solver = solver;
      const SoftMask expected = traced(c, precision);
      EXPECT_GT(std::count_if(expected.visible_fraction.begin(), expected.visible_fraction.end(),
                              [](float f) { return f > 0 && f < 1; }),
                100);
      for (const int k : {-40, -17, -3, 1, 8, 25, 40}) {
        const SoftMask mask = traced(moved(c, std::ldexp(1.0, k), dvec3(0)), precision);
        EXPECT_TRUE(mask.visible_fraction == expected.visible_fraction)
            << "2^" << k << " " << soft_solver_name(solver) << " precision " << int(precision);
        EXPECT_TRUE(mask.irradiance == expected.irradiance)
            << "2^" << k << " " << soft_solver_name(solver) << " precision " << int(precision);
      }
    }
}

TEST(SoftCatalogue, E_ScaledAndMovedScenes) {
  Judgement sum;
  Random random(21);
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    const SoftCase base = small_room(21, 1);
    SoftCase c = moved(base, scale, dvec3(0));
    expect_exact(fmt::format("scale {}", scale), c.soup, c.light, sum, 21);
  }
  for (const double offset : {1e3, 1e5, 1e6}) {
    const SoftCase base = small_room(22, 1);
    SoftCase c = moved(base, 1, offset * glm::normalize(dvec3(1, -2, 3)));
    expect_exact(fmt::format("moved by {}", offset), c.soup, c.light, sum, 22);
  }
  sum.print("scaled and moved");
}

TEST(SoftCatalogue, E_NumbersThatAreNone) {
  Judgement sum;
  SoftCase c = small_room(23, 196);
  const SoftMask clean = traced(c, SoftPrecision::reference);
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  const float largest = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
  for (const float bad : {nan, infinity, -infinity}) {
    c.soup.add({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    c.soup.positions.back().y = bad;
  }
  c.name = "NaN and infinity";
  EXPECT_TRUE(traced(c, SoftPrecision::reference).visible_fraction == clean.visible_fraction);
  judge_all(c, sum);
  c = small_room(23, 196);
  c.soup.add({least, 0, -least}, {-0.0, least, 0}, {0, 0.0, 4 * least});
  c.soup.add({-1, -0.0, -1}, {1, -0.0, -1}, {0, -0.0, 1});
  c.soup.add({-1.8e18, -1.5, -1.8e18}, {1.8e18, -1.5, -1.8e18}, {0, -1.5, 1.8e18});
  c.name = "denormals, minus zero, 1.8e18";
  judge_all(c, sum);
  sum.print("numbers");
  // The largest floats: any answer between 0 and 1, but an answer.
  c.soup.add({-largest, 3, -largest}, {largest, 3, -largest}, {0, 3, largest});
  for (const SoftPrecision precision : {SoftPrecision::reference, SoftPrecision::fast})
    for (const float f : traced(c, precision).visible_fraction) EXPECT_TRUE(f >= 0 && f <= 1) << f;
}

TEST(SoftCatalogue, E_RoundingModeOfTheCallerIsKeptAndDoesNotMatter) {
  const SoftCase c = small_room(24, 196);
  const SoftMask expected = traced(c, SoftPrecision::fast);
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const SoftMask mask = traced(c, SoftPrecision::fast);
    const int after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(after, mode);
    EXPECT_TRUE(mask.visible_fraction == expected.visible_fraction) << mode;
    EXPECT_TRUE(mask.irradiance == expected.irradiance) << mode;
  }
}

}  // namespace
}  // namespace tenebra::testing
