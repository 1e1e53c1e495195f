// The oracle of the soft shadows on cases whose answer is known: closed forms and convex bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "oracle/exact_soft.h"
#include "support/samples.h"
#include "support/soup.h"

namespace tenebra::testing {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;
using oracle::ExactSoft;
using oracle::SoftAnswer;
using oracle::SweepNumbers;

/// A light [-1, 1]^2 at z = 2 that shines down on a ground z = 0 (triangle 0), seen from above.
struct Desk {
  Soup soup;
  AreaLight light = *make_rectangle_light({0, 0, 2}, {1, 0, 0}, {0, -1, 0});
  ViewRays view;
  vec3 normal{0.0f};

  Desk() {
    soup.add({-100, -100, 0}, {100, -100, 0}, {0, 200, 0});
    view.eye = {0, 0, 1};
  }
  SoftAnswer at(dvec3 point, SweepNumbers numbers = SweepNumbers::rational, std::uint32_t id = 0) const {
    return ExactSoft(view, soup.view(), light).answer(point, id, normal, numbers);
  }
  double fraction(dvec3 point = dvec3(0.0)) const {
    const SoftAnswer exact = at(point), rounded = at(point, SweepNumbers::long_double);
    EXPECT_NEAR(exact.visible_fraction, rounded.visible_fraction, rounded.error_bound);
    EXPECT_LT(rounded.error_bound, 1e-14);
    EXPECT_EQ(exact.occluders, rounded.occluders);
    return exact.visible_fraction;
  }
};

TEST(SoftOracle, AnEmptySkyShowsTheWholeLight) {
  const Desk desk;
  EXPECT_EQ(desk.fraction(), 1.0);
  // Configuration factor of a parallel rectangle, corner over the point, sides 1 x 1 at height 2 (Siegel and
  // Howell, C-11), four times.
  const double a = 0.5, r = std::sqrt(1 + a * a);
  const double expected = 4 * 0.5 * 2 * a / r * std::atan(a / r);
  EXPECT_NEAR(desk.at(dvec3(0.0)).irradiance, expected, 1e-15);
}

TEST(SoftOracle, OneTriangleHidesItsProjection) {
  Desk desk;
  desk.soup.add({0, 0, 1}, {0.5, 0, 1}, {0, 0.5, 1});  // projects to the half of a quarter of the light
  EXPECT_EQ(desk.fraction(), 0.875);
  std::swap(desk.soup.triangles[1].x, desk.soup.triangles[1].y);
  EXPECT_EQ(desk.fraction(), 0.875);
  EXPECT_EQ(desk.fraction({1, 1, 0}), 0.75 + 0.125);  // the projection moves to [-1, 0]^2
  EXPECT_EQ(desk.fraction({3, 0, 0}), 1.0);
}

TEST(SoftOracle, HalvesQuartersAndAllOfTheLight) {
  Desk half;
  half.soup.quad({0, -10, 1}, {10, 0, 0}, {0, 20, 0});
  EXPECT_EQ(half.fraction(), 0.5);
  EXPECT_NEAR(half.at(dvec3(0.0)).irradiance, 0.5 * Desk().at(dvec3(0.0)).irradiance, 1e-15);
  half.soup.quad({-10, 0, 1.5}, {20, 0, 0}, {0, 10, 0});  // overlaps the first
  EXPECT_EQ(half.fraction(), 0.25);
  half.soup.quad({-10, -10, 0.5}, {20, 0, 0}, {0, 20, 0});
  EXPECT_EQ(half.fraction(), 0.0);
  EXPECT_EQ(half.at(dvec3(0.0)).irradiance, 0.0);
  EXPECT_TRUE(half.at(dvec3(0.0)).visible.empty());
}

TEST(SoftOracle, OccludersAcrossTheLightsPlaneHideTheirPartBelowIt) {
  Desk desk;
  desk.soup.quad({0.5, -10, 1}, {0, 20, 0}, {0, 0, 3});  // hides 1/2 < u <= 1: its plane cuts the light
  EXPECT_EQ(desk.fraction(), 0.75);
  Desk behind;
  behind.soup.quad({-10, -10, 2.25}, {20, 0, 0}, {0, 20, 0});
  EXPECT_EQ(behind.fraction(), 1.0);
  Desk on_the_plane;
  on_the_plane.soup.quad({-10, -10, 2}, {20, 0, 0}, {0, 20, 0});  // touches no segment before its end
  EXPECT_EQ(on_the_plane.fraction(), 1.0);
}

TEST(SoftOracle, OccludersThroughThePointDoNotBlock) {
  Desk desk;
  desk.soup.quad({0, -10, -1}, {0, 20, 0}, {0, 0, 4});  // its plane holds the point
  EXPECT_EQ(desk.fraction(), 1.0);
  // A wall that stands on the ground at x = 1: theta = tau |n| is (100 and 20) sqrt(3) 2^-24 off its plane.
  Desk wall;
  wall.soup.quad({1, -10, 0}, {0, 20, 0}, {0, 0, 20});
  const double theta = std::sqrt(3.0) * 0x1p-24 * (200 + 20);
  EXPECT_EQ(wall.fraction({1 - 0.999 * theta, 0, 0}), 1.0);
  EXPECT_EQ(wall.fraction({1 - 1.001 * theta, 0, 0}), 1.0);  // the light is on the point's side of the wall
  EXPECT_EQ(wall.fraction({1 + 0.999 * theta, 0, 0}), 1.0);
  EXPECT_EQ(wall.fraction({1 + 1.001 * theta, 0, 0}), 0.0);
}

TEST(SoftOracle, ContactsCloseTheShadow) {
  // A plate that lies on the ground, 2 theta above: everything below it is dark.
  Desk desk;
  const double theta = std::sqrt(3.0) * 0x1p-24 * (200 + 10);
  desk.soup.quad({-10, -10, 2 * theta}, {20, 0, 0}, {0, 20, 0});
  EXPECT_EQ(desk.fraction(), 0.0);
  desk.soup.positions.resize(3), desk.soup.triangles.resize(1);
  desk.soup.quad({-10, -10, 0.5 * theta}, {20, 0, 0}, {0, 20, 0});  // within the rounding: the same surface
  EXPECT_EQ(desk.fraction(), 1.0);
}

TEST(SoftOracle, TheHorizonCutsTheLight) {
  Desk desk;
  desk.soup.positions[0] = {0, -100, -100};  // the plane x = 0 halves the light
  desk.soup.positions[1] = {0, 100, -100};
  desk.soup.positions[2] = {0, 0, 200};
  desk.view.eye = {1, 0, 0};
  EXPECT_EQ(desk.fraction(), 0.5);
  desk.view.eye = {-1, 0, 0};
  EXPECT_EQ(desk.fraction(), 0.5);
  desk.view.eye = {0, 1, 0};  // edge-on
  EXPECT_EQ(desk.fraction(), 0.0);
  desk.view.orthographic = true;
  desk.view.d0 = {-1, 0, 0};
  EXPECT_EQ(desk.fraction(), 0.5);
  // The corner of a unit square in the plane z = 2 above the edge of the half space x > 0.
  const double a = 0.5;
  const double perpendicular = std::atan(1 / (2 * 1.0)) - 2 / std::sqrt(5.0) * std::atan(1 / std::sqrt(5.0));
  EXPECT_NEAR(desk.at(dvec3(0.0)).irradiance, perpendicular, 1e-15) << a;
}

TEST(SoftOracle, PointsBehindOrOnTheLightSeeNothing) {
  Desk desk;
  EXPECT_EQ(desk.fraction({0, 0, 2}), 0.0);
  EXPECT_EQ(desk.fraction({5, 0, 2}), 0.0);
  EXPECT_EQ(desk.fraction({0, 0, 2.5}), 0.0);
  EXPECT_GT(desk.fraction({0, 0, std::nextafter(2.0, 0.0)}), 0.0);
}

TEST(SoftOracle, BackgroundFlagsAndOwnTriangle) {
  Desk desk;
  desk.soup.quad({0, -10, 1}, {10, 0, 0}, {0, 20, 0});
  EXPECT_EQ(desk.at(dvec3(0.0), SweepNumbers::rational, no_triangle).visible_fraction, 0.0);
  EXPECT_EQ(desk.fraction(), 0.5);
  desk.soup.casts = {1, 1, 0};  // the triangle that is left passes beside the light
  EXPECT_EQ(desk.fraction(), 1.0);
  desk.soup.casts = {1, 0, 1};
  EXPECT_EQ(desk.fraction(), 0.5);
  desk.soup.casts = {1, 0, 0};
  EXPECT_EQ(desk.fraction(), 1.0);
  desk.soup.casts = {};
  // A ground that does not hold the point would block; as the own triangle it does not.
  EXPECT_EQ(desk.fraction({0, 0, -0.5}), 0.5);
  EXPECT_EQ(desk.at({0, 0, -0.5}, SweepNumbers::rational, 1).visible_fraction, 0.0);
  desk.soup.positions[7] = vec3(std::nanf(""));  // of triangle 2, which covers the half
  EXPECT_EQ(desk.fraction(), 1.0);
  desk.soup.positions[1] = desk.soup.positions[0];
  EXPECT_EQ(desk.fraction(), 0.0);  // a receiver without area
}

/// Area of the hull of `points`.
double hull_area(std::vector<dvec2> points) {
  const auto turn = [](dvec2 o, dvec2 a, dvec2 b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
  };
  std::sort(points.begin(), points.end(),
            [](dvec2 a, dvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  double doubled = 0;
  for (int half = 0; half < 2; ++half) {
    std::vector<dvec2> chain;
    for (const dvec2& p : points) {
      while (chain.size() > 1 && turn(chain[chain.size() - 2], chain.back(), p) <= 0) chain.pop_back();
      chain.push_back(p);
    }
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      doubled += chain[i].x * chain[i + 1].y - chain[i].y * chain[i + 1].x;
    std::reverse(points.begin(), points.end());
  }
  return doubled / 2;
}

Soup tetrahedron(const dvec3 corners[4]) {
  Soup soup;
  for (int k = 0; k < 4; ++k) soup.add(corners[k], corners[(k + 1) % 4], corners[(k + 2) % 4]);
  return soup;
}

TEST(SoftOracle, ConvexBodiesHideTheHullOfTheirCornersWithoutCracks) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    Desk desk;
    // Within the light's square as seen from the point: 2 * (0.15 + 0.12) / (0.7 - 0.12) < 1.
    const double radius = random.in(0.05, 0.12);
    const dvec3 centre(random.in(-0.15, 0.15), random.in(-0.15, 0.15), random.in(0.7, 1.3));
    dvec3 corners[4];
    for (dvec3& corner : corners) corner = centre + random.in_cube(radius);
    desk.soup.append(i % 2 == 0 ? tetrahedron(corners)
                                : box(centre - 0.3 * radius, centre + dvec3(radius, 0.5 * radius, radius)));
    std::vector<dvec2> projected;
    for (std::size_t k = 3; k < desk.soup.positions.size(); ++k) {
      const dvec3 q(desk.soup.positions[k]);
      projected.emplace_back(2 * q.x / q.z, 2 * q.y / q.z);
    }
    EXPECT_NEAR(desk.fraction(), 1 - hull_area(projected) / 4, 1e-14) << "case " << i;
  }
}

TEST(SoftOracle, InsideAClosedBodyTheLightIsHiddenWhole) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    Desk desk;
    desk.soup.append(sphere(4, 1.5, random.in_cube(0.3)));
    const dvec3 point(random.in(-0.4, 0.4), random.in(-0.4, 0.4), 0);
    const SoftAnswer rounded = desk.at(point, SweepNumbers::long_double);
    EXPECT_LE(rounded.visible_fraction, rounded.error_bound) << "case " << i;
    if (i < 4) {
      EXPECT_EQ(desk.at(point).visible_fraction, 0.0) << "case " << i;
    }
  }
}

TEST(SoftOracle, IrradianceIsTheIntegralOverTheVisibleRegion) {
  Random random(6);
  const double node = 0.5 / std::sqrt(3.0);
  for (int i = 0; i < 20; ++i) {
    Desk desk;
    desk.soup.append(sphere(2, 0.3, random.in_cube(0.3) + dvec3(0, 0, 1)));
    desk.normal = vec3(glm::normalize(dvec3(random.in(-1, 1), random.in(-1, 1), random.in(0, 1))));
    const SoftAnswer answer = desk.at({0.1, 0.2, 0}, SweepNumbers::long_double);
    double sum = 0;
    constexpr int parts = 24;  // Gauss's rule of two points on 24 x 24 cells a trapezoid
    for (const oracle::Trapezoid& t : answer.visible)
      for (int a = 0; a < 2 * parts; ++a)
        for (int b = 0; b < 2 * parts; ++b) {
          const double s = (a / 2 + 0.5 + (a % 2 ? node : -node)) / parts;
          const double r = (b / 2 + 0.5 + (b % 2 ? node : -node)) / parts;
          const double low = double(t.low_left + s * (t.low_right - t.low_left));
          const double high = double(t.high_left + s * (t.high_right - t.high_left));
          const double u = double(t.left + s * (t.right - t.left)), v = low + r * (high - low);
          const dvec3 q = desk.light.centre + u * desk.light.ex + v * desk.light.ey - dvec3(0.1, 0.2, 0);
          const double d = glm::length(q);
          const double cosines = std::max(glm::dot(dvec3(desk.normal), q), 0.0) * q.z / (d * d);
          sum += cosines / (d * d) * (high - low) * double(t.right - t.left) / (4 * parts * parts);
        }
    EXPECT_NEAR(answer.irradiance, sum, 1e-4 * sum + 1e-6) << "case " << i;
  }
}

}  // namespace
}  // namespace tenebra::testing
