#include <tenebra/area_light.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/seeded_random.h"

namespace tenebra::testing {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// A random frame: right-handed, orthonormal up to double rounding.
struct Frame {
  dvec3 x, y, z;
  explicit Frame(Random& random) {
    x = glm::normalize(random.in_cube(1));
    z = glm::normalize(glm::cross(x, random.in_cube(1)));
    y = glm::cross(z, x);
  }
};

/// Corners of a convex polygon: points of an ellipse at random angles, in order.
std::vector<dvec2> random_convex(Random& random, int count) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back(2 * std::numbers::pi * (i + random.in(0.1, 0.9)) / count);
  const double a = std::exp2(random.in(-4, 4)), b = std::exp2(random.in(-4, 4));
  std::vector<dvec2> points;
  for (const double angle : angles) points.emplace_back(a * std::cos(angle), b * std::sin(angle));
  return points;
}

std::vector<vec3> placed(const std::vector<dvec2>& points, const Frame& frame, dvec3 offset, double scale) {
  std::vector<vec3> out;
  for (const dvec2& p : points) out.emplace_back(offset + scale * (p.x * frame.x + p.y * frame.y));
  return out;
}

double tau_of(const std::vector<vec3>& vertices) {
  double largest = 0;
  for (const vec3& v : vertices)
    for (int k = 0; k < 3; ++k) largest = std::max(largest, double(std::abs(v[k])));
  return std::sqrt(3.0) * 0x1p-24 * largest;
}

/// What every light must be, whatever it was made from.
void expect_sound(const AreaLight& light) {
  ASSERT_EQ(light.vertices.size(), light.polygon.size());
  ASSERT_GE(light.polygon.size(), 3u);
  const double unit = 1e-15;
  EXPECT_NEAR(glm::length(light.ex), 1, 8 * unit);
  EXPECT_NEAR(glm::length(light.ey), 1, 8 * unit);
  EXPECT_NEAR(glm::length(light.normal), 1, 8 * unit);
  EXPECT_NEAR(glm::dot(light.ex, light.normal), 0, 8 * unit);
  EXPECT_NEAR(glm::length(glm::cross(light.ex, light.ey) - light.normal), 0, 16 * unit);
  const double tau = tau_of(light.vertices);
  double doubled = 0;
  dvec2 moment(0.0);
  const std::size_t count = light.polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const dvec2 p = light.polygon[i], q = light.polygon[(i + 1) % count];
    const dvec3 world = light.centre + p.x * light.ex + p.y * light.ey;
    EXPECT_LE(glm::length(world - dvec3(light.vertices[i])), 6.001 * tau) << "vertex " << i;
    EXPECT_GT(cross(q - p, light.polygon[(i + 2) % count] - q), 0) << "vertex " << i;
    doubled += cross(p, q);
    moment += cross(p, q) * (p + q);
  }
  EXPECT_NEAR(light.area_m2, 0.5 * doubled, 1e-12 * light.area_m2);
  const double size = std::sqrt(doubled) + glm::length(light.polygon[0]);
  EXPECT_LE(glm::length(moment / (3 * doubled)), 1e-12 * size + 1e-2 * tau);
}

std::string refusal(const std::vector<vec3>& vertices) {
  const auto light = make_area_light(vertices);
  return light ? "(accepted)" : light.error().message;
}
void expect_refused(const std::vector<vec3>& vertices, const std::string& what) {
  EXPECT_NE(refusal(vertices).find(what), std::string::npos) << refusal(vertices);
}

TEST(AreaLight, SquareHasItsFrame) {
  const auto light = make_area_light(std::vector<vec3>{{1, 2, 3}, {3, 2, 3}, {3, 4, 3}, {1, 4, 3}});
  ASSERT_TRUE(light);
  expect_sound(*light);
  EXPECT_EQ(light->centre, dvec3(2, 3, 3));
  EXPECT_EQ(light->normal, dvec3(0, 0, 1));
  EXPECT_EQ(light->ex, dvec3(1, 0, 0));
  EXPECT_EQ(light->polygon, (std::vector<dvec2>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}));
  EXPECT_EQ(light->area_m2, 4);
}

TEST(AreaLight, TheOrderOfTheVerticesDecidesTheSideThatShines) {
  const auto light = make_area_light(std::vector<vec3>{{1, 4, 3}, {3, 4, 3}, {3, 2, 3}, {1, 2, 3}});
  ASSERT_TRUE(light);
  EXPECT_EQ(light->normal, dvec3(0, 0, -1));
}

TEST(AreaLight, RectanglesShineAlongTheCrossOfTheirHalves) {
  const auto light = make_rectangle_light({5, 6, 7}, {0, 2, 0}, {0, 0, 0.5f});
  ASSERT_TRUE(light);
  expect_sound(*light);
  EXPECT_EQ(light->normal, dvec3(1, 0, 0));
  EXPECT_EQ(light->centre, dvec3(5, 6, 7));
  EXPECT_EQ(light->area_m2, 4);
}

TEST(AreaLight, DiscsHaveTheDiscsArea) {
  const auto light = make_disc_light({5, 6, 7}, {2, 0, 0}, {0, 3, 0});
  ASSERT_TRUE(light);
  expect_sound(*light);
  EXPECT_EQ(light->polygon.size(), 12u);
  EXPECT_NEAR(light->area_m2, 6 * std::numbers::pi, 1e-5);
  EXPECT_NEAR(light->normal.z, 1, 1e-6);
}

TEST(AreaLight, PlanarConvexPolygonsAreAcceptedWhereverTheyLie) {
  Random random(1);
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    const int count = 3 + static_cast<int>(random.index(12));
    const Frame frame(random);
    const double away = std::exp2(random.in(-10, 14)), scale = std::exp2(random.in(-6, 6));
    const auto vertices = placed(random_convex(random, count), frame, random.in_cube(away), scale);
    const auto light = make_area_light(vertices);
    // The rounding may leave no area, or no convexity that the coordinates can tell; never a bent plane.
    if (!light) {
      EXPECT_NE(light.error().message.find("encloses"), std::string::npos) << light.error().message;
      continue;
    }
    ++accepted;
    expect_sound(*light);
    EXPECT_GT(glm::dot(light->normal, frame.z), 0) << "case " << i;
    if (::testing::Test::HasFailure()) FAIL() << "case " << i;
  }
  EXPECT_GT(accepted, 19000);
}

TEST(AreaLight, RectanglesAndDiscsAreAcceptedFarFromTheOrigin) {
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    const Frame frame(random);
    const vec3 centre(random.in_cube(std::exp2(random.in(0, 20))));
    const double size = std::exp2(random.in(-3, 4)) * (1 + 2e-5 * glm::length(dvec3(centre)));
    const vec3 x(size * frame.x), y(size * random.in(0.1, 1) * frame.y);
    const auto rectangle = make_rectangle_light(centre, x, y);
    ASSERT_TRUE(rectangle) << "case " << i << ": " << rectangle.error().message;
    EXPECT_EQ(rectangle->polygon.size(), 4u);
    expect_sound(*rectangle);
    const auto disc = make_disc_light(centre, x, y);
    ASSERT_TRUE(disc) << "case " << i << ": " << disc.error().message;
    expect_sound(*disc);
  }
}

TEST(AreaLight, BentPolygonsAreRefusedAsSoonAsRoundingCannotExplainThem) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Frame frame(random);
    std::vector<dvec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const dvec3 offset = random.in_cube(std::exp2(random.in(0, 10)));
    std::vector<vec3> vertices = placed(square, frame, offset, 1);
    // One corner lifted by h leaves all four h/4 off the best plane.
    const double lift = 32 * tau_of(vertices) * random.in(1, 1000);
    vertices[i % 4] = vec3(offset + square[i % 4].x * frame.x + square[i % 4].y * frame.y + lift * frame.z);
    expect_refused(vertices, "off the plane of the polygon");
  }
}

TEST(AreaLight, CollinearAndRepeatedVerticesAreDropped) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Frame frame(random);
    const std::vector<dvec2> with_extra{{-1, -1}, {-0.3, -1}, {0.5, -1}, {1, -1}, {1, -1},
                                        {1, 1},   {1, 1},     {-0.1, 1}, {-1, 1}, {-1, 0}};
    const dvec3 offset = random.in_cube(std::exp2(random.in(0, 12)));
    const auto light = make_area_light(placed(with_extra, frame, offset, 1));
    ASSERT_TRUE(light) << light.error().message;
    EXPECT_EQ(light->polygon.size(), 4u) << "case " << i;
    expect_sound(*light);
  }
}

TEST(AreaLight, SmallBendsDoNotAddUp) {
  // A shallow notch of eight vertices, each of which bends by less than the rounding at offset 4096.
  std::vector<dvec2> points{{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  const double tau = std::sqrt(3.0) * 0x1p-24 * 4097;
  for (int k = 1; k < 8; ++k) {
    const double x = -1 + k / 4.0;
    points.emplace_back(x, -1 + 20 * tau * (1 - x * x));
  }
  Random random(5);
  const Frame frame(random);
  expect_refused(placed(points, frame, 4096.0 * glm::normalize(dvec3(1, 1, 1)) * std::sqrt(3.0), 1),
                 "expected a convex polygon");
}

TEST(AreaLight, ConcaveAndSelfCrossingPolygonsAreRefused) {
  expect_refused({{0, 0, 0}, {2, 0, 0}, {1, 0.5f, 0}, {2, 2, 0}, {0, 2, 0}}, "expected a convex");
  expect_refused({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, "encloses 0 m2");      // a bow tie
  expect_refused({{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 2, 0}}, "expected a convex");  // a lopsided one
  expect_refused({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}},  // twice round
                 "expected a convex");
  std::vector<vec3> star;
  for (int i = 0; i < 5; ++i)
    star.emplace_back(std::cos(0.8 * i * std::numbers::pi), std::sin(0.8 * i * std::numbers::pi), 0);
  expect_refused(star, "expected a convex");
  expect_refused({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 3, 0}, {2, 2, 0}, {0, 2, 0}},  // a spike
                 "expected a convex");
}

TEST(AreaLight, RefusesWhatHasNoArea) {
  expect_refused({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, "encloses 0 m2");
  expect_refused({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, "encloses 0 m2");
  // Thinner than the rounding at 1000 m; the same at the origin is a light.
  expect_refused({{1000, 0, 0}, {1001, 0, 0}, {1001, 1e-6f, 0}, {1000, 1e-6f, 0}}, "encloses 1e-06 m2");
  EXPECT_TRUE(make_area_light(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1e-6f, 0}, {0, 1e-6f, 0}}));
  EXPECT_FALSE(make_rectangle_light({0, 0, 0}, {1, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(make_rectangle_light({1e6f, 0, 0}, {1e-3f, 0, 0}, {0, 1e-3f, 0}));
}

TEST(AreaLight, RefusesWrongCountsAndNumbers) {
  expect_refused({}, "found a polygon of 0 vertices, expected 3 to 14");
  expect_refused({{0, 0, 0}, {1, 0, 0}}, "found a polygon of 2 vertices, expected 3 to 14");
  expect_refused(std::vector<vec3>(15), "found a polygon of 15 vertices, expected 3 to 14");
  expect_refused({{0, 0, 0}, {1, nan, 0}, {1, 1, 0}}, "vertex 1 is (1, nan, 0), expected finite");
  expect_refused({{0, 0, 0}, {1, 0, 0}, {1, 1, -infinity}}, "vertex 2 is (1, 1, -inf), expected finite");
  EXPECT_FALSE(make_rectangle_light({3e38f, 0, 0}, {3e38f, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(make_disc_light({0, 0, 0}, {nan, 0, 0}, {0, 1, 0}));
}

TEST(AreaLight, SizesFromTheSmallestFloatsToTheLargest) {
  for (int k = -120; k <= 120; k += 4) {
    const auto light =
        make_rectangle_light(vec3(0), {std::ldexp(1.0f, k), 0, 0}, {0, 0, std::ldexp(0.75f, k)});
    ASSERT_TRUE(light) << "2^" << k << ": " << light.error().message;
    EXPECT_EQ(light->area_m2, std::ldexp(3.0, 2 * k));
    EXPECT_EQ(light->normal, dvec3(0, -1, 0));
  }
}

TEST(AreaLight, ScalingByPowersOfTwoKeepsTheBits) {
  Random random(6);
  const Frame frame(random);
  const auto base = placed(random_convex(random, 9), frame, {3, 2, 1}, 1);
  const auto light = make_area_light(base);
  ASSERT_TRUE(light);
  for (int k = -40; k <= 40; ++k) {
    std::vector<vec3> scaled;
    for (const vec3& v : base) scaled.push_back(v * std::ldexp(1.0f, k));
    const auto other = make_area_light(scaled);
    ASSERT_TRUE(other);
    EXPECT_EQ(other->normal, light->normal);
    EXPECT_EQ(other->ex, light->ex);
    EXPECT_EQ(other->centre, light->centre * std::ldexp(1.0, k));
    EXPECT_EQ(other->polygon[5], light->polygon[5] * std::ldexp(1.0, k));
  }
}

}  // namespace
}  // namespace tenebra::testing
