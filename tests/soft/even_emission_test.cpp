// Lights that shine alike in every direction, against sums over small pieces of them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <tenebra/threads.h>
#include "soft/light/even_emission.h"

namespace tenebra {
namespace {

using glm::dvec3;

AreaLight rectangle(double width, double height) {
  return make_rectangle_light({0.1f, 2.0f, -0.3f}, {static_cast<float>(width / 2), 0, 0},
                              {0, 0, static_cast<float>(height / 2)})
      .value();  // shines down
}

struct Sums {
  double even = 0, lambert = 0, bare = 0;  // bare: even without the cosine at the surface
};
/// By the middles of `side` x `side` pieces.
Sums summed(const AreaLight& light, const dvec3& at, const dvec3& normal, int side) {
  const auto& v = light.polygon;
  const glm::dvec2 x = v[1] - v[0], y = v[3] - v[0];
  Sums sums;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const glm::dvec2 place = v[0] + (i + 0.5) / side * x + (j + 0.5) / side * y;
      const dvec3 to = light.centre + place.x * light.ex + place.y * light.ey - at;
      const double d2 = glm::dot(to, to), d = std::sqrt(d2), piece = light.area_m2 / side / side;
      const double cosine = std::max(glm::dot(normal, to) / d, 0.0);
      sums.even += piece * cosine / d2;
      sums.lambert += piece * cosine / d2 * std::abs(glm::dot(light.normal, to)) / d;
      sums.bare += piece / d2;
    }
  }
  return sums;
}

struct Place {
  dvec3 at, normal;
};
std::vector<Place> random_places(int count, double nearest, double farthest) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  const auto direction = [&] {
    return glm::normalize(dvec3(normal(random), normal(random), normal(random)));
  };
  std::vector<Place> places;
  for (int i = 0; i < count; ++i)
    places.push_back(
        {dvec3(0.1, 2, -0.3) + nearest * std::pow(farthest / nearest, unit(random)) * direction(),
         glm::vec3(direction())});  // a float's normal, as those of masks
  return places;
}

TEST(EvenEmission, IsTheIntegralOverTheLightOnBothSidesAndAcrossTheHorizon) {
  const AreaLight light = rectangle(1.5, 0.5);
  std::size_t behind = 0, across = 0;
  for (const Place& place : random_places(300, 0.5, 30)) {
    const Sums expected = summed(light, place.at, place.normal, 400);
    EXPECT_NEAR(soft::even_irradiance(light, place.at, place.normal), expected.even, 3e-5 * expected.bare);
    EXPECT_NEAR(soft::whole_irradiance(light, place.at, place.normal), expected.lambert,
                3e-5 * expected.bare);
    behind += glm::dot(light.normal, place.at - light.centre) < 0;
    const double whole = summed(light, place.at, place.normal, 3).even,
                 turned = summed(light, place.at, -place.normal, 3).even;
    across += whole > 0 && turned > 0;
  }
  EXPECT_GT(behind, 100u);
  EXPECT_GT(across, 10u);
}

TEST(EvenEmission, IsThePointLightFromAfarHoweverItIsTurned) {
  const AreaLight light = rectangle(1, 1);
  for (const Place& place : random_places(200, 1e3, 1e6)) {
    const dvec3 to = light.centre - place.at;
    const double d2 = glm::dot(to, to), cosine = glm::dot(place.normal, to) / std::sqrt(d2);
    EXPECT_NEAR(soft::even_irradiance(light, place.at, place.normal) * d2, std::max(cosine, 0.0), 1e-3);
  }
}

TEST(EvenEmission, TheBackIsTheSamePolygonTurned) {
  const AreaLight light = rectangle(1.5, 0.5), back = soft::reversed(light);
  EXPECT_EQ(back.normal, -light.normal);
  EXPECT_EQ(back.vertices.size(), 4u);
  const Place place{{0.3, 3.0, 0.1}, {0, -1, 0}};
  EXPECT_NEAR(soft::even_irradiance(light, place.at, place.normal),
              soft::even_irradiance(back, place.at, place.normal), 1e-14);
}

/// Masks of points that see all, part or nothing of a light.
struct Case {
  VisiblePoints points;
  std::vector<glm::vec3> normals;
  SoftMask mask;

  Case(const AreaLight& light, const std::vector<Place>& places) {
    points.width = static_cast<int>(places.size());
    points.height = 1;
    for (std::size_t i = 0; i < places.size(); ++i) {
      points.positions.push_back(places[i].at);
      points.triangles.push_back(i % 17 == 3 ? no_triangle : 0);
      normals.emplace_back(places[i].normal);
      const float share[3] = {1.0f, 0.25f, 0.0f};
      const double whole = soft::whole_irradiance(light, places[i].at, places[i].normal);
      const bool seen = points.triangles[i] == 0 && whole > 0;
      mask.visible_fraction.push_back(seen ? share[i % 3] : 0.0f);
      mask.irradiance.push_back(seen ? static_cast<float>(share[i % 3] * whole) : 0.0f);
    }
  }
};

TEST(EvenEmission, WeighsMasksByTheShareThatIsSeen) {
  const AreaLight light = rectangle(0.8, 0.6);
  const std::vector<Place> places = random_places(3000, 0.3, 300);
  Case c(light, places);
  const SoftMask before = c.mask;
  soft::weigh_evenly(c.points, c.normals, light, SimdLevel::automatic, c.mask);
  EXPECT_EQ(c.mask.visible_fraction, before.visible_fraction);
  std::size_t lit = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const dvec3 to = light.centre - places[i].at;
    const double scale = light.area_m2 / glm::dot(to, to);
    const double whole = soft::even_irradiance(light, places[i].at, places[i].normal);
    if (before.irradiance[i] == 0) {
      EXPECT_EQ(c.mask.irradiance[i], 0.0f);
    } else {
      EXPECT_NEAR(c.mask.irradiance[i], before.visible_fraction[i] * whole, 1e-5 * scale + 1e-6 * whole);
      ++lit;
    }
  }
  EXPECT_GT(lit, 500u);
}

TEST(EvenEmission, HasTheSameBitsForEveryLevelAndThreadCount) {
  const AreaLight light = rectangle(0.8, 0.6);
  const Case original(light, random_places(20000, 0.3, 300));
  std::vector<float> expected;
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    for (const int threads : {1, 3}) {
      Case c = original;
      with_threads(threads, [&] { soft::weigh_evenly(c.points, c.normals, light, level, c.mask); });
      if (expected.empty()) expected = c.mask.irradiance;
      EXPECT_EQ(c.mask.irradiance, expected) << simd_level_name(level) << " " << threads;
    }
  }
}

// The light's corners lie on the horizon up to rounding, which puts them on either side of it in turn: more
// pieces than a cut of a convex polygon has.
TEST(EvenEmission, IsNothingForPointsInTheLightsPlane) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  const auto vector = [&] { return glm::vec3(coordinate(random), coordinate(random), coordinate(random)); };
  for (int light = 0; light < 200; ++light) {
    const glm::vec3 axis = glm::normalize(vector());
    const glm::vec3 x = glm::normalize(glm::cross(axis, vector())), y = glm::cross(axis, x);
    const AreaLight disc = make_disc_light(3.0f * vector(), x, y).value();
    for (int place = 0; place < 1000; ++place) {
      const double angle = 3.14 * coordinate(random), distance = 3 + coordinate(random);
      const dvec3 at = disc.centre + distance * (std::cos(angle) * disc.ex + std::sin(angle) * disc.ey);
      const dvec3 normal = place % 2 == 0 ? disc.normal : -disc.normal;
      EXPECT_LT(soft::whole_irradiance(disc, at, normal), 1e-12);
      EXPECT_LT(soft::even_irradiance(disc, at, normal), 1e-12);
    }
  }
}

TEST(EvenEmission, OtherPolygonsAreWeighedToo) {
  const AreaLight disc = make_disc_light({0, 2, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}).value();
  Case c(disc, random_places(300, 5, 100));
  const SoftMask before = c.mask;
  soft::weigh_evenly(c.points, c.normals, disc, SimdLevel::automatic, c.mask);
  for (std::size_t i = 0; i < c.normals.size(); ++i) {
    if (before.visible_fraction[i] < 1) continue;
    const double whole = soft::even_irradiance(disc, c.points.positions[i], c.normals[i]);
    EXPECT_NEAR(c.mask.irradiance[i], whole, 1e-6 * whole);
  }
}

}  // namespace
}  // namespace tenebra
