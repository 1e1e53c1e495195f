// The sampling contestants against closed forms: what they measure must be what Tenebra measures.
#include "bench/soft/soft_embree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/soft/soft_quality.h"
#include "parallel/parallel.h"

namespace tenebra::bench {

void PrintTo(Packing packing, std::ostream* out) {  // CTest's name of the test
  *out << packing_name(packing);
}

namespace {

/// A floor of two triangles seen from above; with a `blocker`, half of the light's side is covered for all of
/// it.
struct FloorScene {
  static constexpr int width = 24, height = 16;

  explicit FloorScene(bool blocker) {
    FrameGeometry& g = frame.geometry;
    g.positions = {{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}};
    g.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (blocker) {  // just below the light, under its half x > 1
      g.positions.insert(g.positions.end(), {{1, 3.999f, -50}, {1, 3.999f, 50}, {60, 3.999f, 0}});
      g.triangles.emplace_back(4, 5, 6);
    }
    g.casts_shadow.assign(g.triangles.size(), 1);
    g.normals.assign(g.positions.size(), glm::vec3(0));
    frame.view = look_at({0, 3, 6}, {0, 0, 0}, {0, 1, 0}, 0.8f, 0.1f, width, height);
    const auto ids = nearest_triangles(frame.triangles(), frame.view, width, height);
    compute_visible_points(ids, width, height, frame.view, frame.triangles(), frame.points);
    compute_shading_normals(frame.points, g.normals, frame.triangles(), frame.normals);
    frame.diagonal_m = 20;
  }

  std::vector<float> sampled(std::size_t rays, Packing packing) const {
    std::vector<float> irradiance(frame.pixel_count(), -1.0f);
    SoftSampler(light, rays, packing)
        .trace(EmbreeScene(frame.triangles(), true), sampled_receivers(frame), width, height, {}, irradiance);
    return irradiance;
  }

  BenchFrame frame;
  AreaLight light = make_rectangle_light({1, 4, 0}, {1.5f, 0, 0}, {0, 0, 1}).value();  // shines down
};

/// Irradiance of a floor point below a parallel rectangle, from the form factor of a patch above one of its
/// corners (Howell, configuration B-3); inclusion and exclusion of the four corners.
double floor_irradiance(double x0, double x1, double z0, double z1, double height) {
  const auto corner = [&](double x, double z) {
    const double a = x / height, b = z / height, ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
    return 0.5 * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb));
  };
  return corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0);
}

double expected(const FloorScene& scene, std::size_t pixel, double highest_x) {
  const glm::dvec3 p = scene.frame.points.positions[pixel];
  return floor_irradiance(-0.5 - p.x, highest_x - p.x, -1 - p.z, 1 - p.z, 4);
}

TEST(Unoccluded, IsTheFormFactorOfARectangleAboveAFloor) {
  const FloorScene scene(false);
  for (std::size_t i = 0; i < scene.frame.pixel_count(); ++i) {
    if (scene.frame.points.triangles[i] == no_triangle) continue;
    const Unoccluded all = unoccluded(scene.light, scene.frame.points.positions[i],
                                      glm::dvec3(scene.frame.normals[i]), {0, 1, 0});
    EXPECT_NEAR(all.irradiance, expected(scene, i, 2.5), 1e-9);
    EXPECT_NEAR(all.fraction, 1, 1e-12);
  }
}

class Sampler : public ::testing::TestWithParam<Packing> {};

TEST_P(Sampler, ConvergesToTheClosedFormOverAFloor) {
  const FloorScene scene(false);
  const std::vector<float> irradiance = scene.sampled(1024, GetParam());
  // 32 x 32 cells, the integrand (mean 0.24) varying by about its mean across the light: a cell's deviation
  // is 0.24 / 32 / sqrt(6), that of the mean of 1,024 a 32nd of it, 1e-4; four of them for 384 pixels.
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    const bool seen = scene.frame.points.triangles[i] != no_triangle;
    EXPECT_NEAR(irradiance[i], seen ? expected(scene, i, 2.5) : 0.0, 4e-4) << "pixel " << i;
  }
}

TEST_P(Sampler, SeesTheFreePartOfAHalfCoveredLight) {
  const FloorScene scene(true);
  const std::vector<float> irradiance = scene.sampled(1024, GetParam());
  double bias = 0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    if (scene.frame.points.triangles[i] > 1) continue;  // the floor only
    // The edge at x = 1, a thousandth below the light, is seen against x = 1 + 0.001/4 (1 - p.x) or so.
    const double e = expected(scene, i, 1.0);
    EXPECT_NEAR(irradiance[i], e, 0.04 * e) << "pixel " << i;
    bias += irradiance[i] / e - 1;
    ++seen;
  }
  ASSERT_GT(seen, 100u);
  EXPECT_NEAR(bias / static_cast<double>(seen), 0, 2e-3);
}

TEST_P(Sampler, OfASunSeesAllOfItOrWhatHidesItAtAnyDistance) {
  FloorScene scene(true);
  scene.light = make_sun({0, 1, 0}, 4).value();  // the blocker, four metres up, blurs its edge by 0.28 m
  const std::vector<float> irradiance = scene.sampled(256, GetParam());
  std::size_t lit = 0, dark = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    if (scene.frame.points.triangles[i] > 1) continue;  // the floor only
    const glm::dvec3 p = scene.frame.points.positions[i];
    if (p.x < 0.85) {
      const double all = unoccluded(scene.light, p, glm::dvec3(scene.frame.normals[i]), {0, 1, 0}).irradiance;
      // 16 x 16 cells of a 4-degree disc, seen under almost one angle: what varies is far below this.
      EXPECT_NEAR(irradiance[i], all, 2e-3 * all) << "pixel " << i;
      ++lit;
    } else if (p.x > 1.15) {
      EXPECT_EQ(irradiance[i], 0) << "pixel " << i;
      ++dark;
    }
  }
  EXPECT_GT(lit, 50u);
  EXPECT_GT(dark, 20u);
}

TEST_P(Sampler, LeavesAloneWhatIsNotWanted) {
  const FloorScene scene(true);
  std::vector<std::uint8_t> wanted(scene.frame.pixel_count());
  for (std::size_t i = 0; i < wanted.size(); i += 3) wanted[i] = 1;
  const std::vector<float> all = scene.sampled(16, GetParam());
  std::vector<float> some(wanted.size(), -1.0f);
  SoftSampler(scene.light, 16, GetParam())
      .trace(EmbreeScene(scene.frame.triangles(), true), sampled_receivers(scene.frame), FloorScene::width,
             FloorScene::height, wanted, some);
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_EQ(some[i], wanted[i] != 0 ? all[i] : -1.0f);
}

TEST_P(Sampler, GivesTheSameBitsOnOneThread) {
  const FloorScene scene(true);
  std::vector<float> one;
  with_threads(1, [&] { one = scene.sampled(64, GetParam()); });
  EXPECT_EQ(one, scene.sampled(64, GetParam()));
}

TEST_P(Sampler, FewerRaysThanLanesAreJustNoisier) {
  const FloorScene scene(false);
  for (const std::size_t rays : {1, 2, 4, 8}) {
    const std::vector<float> irradiance = scene.sampled(rays, GetParam());
    double ratio = 0, seen = 0;
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
      if (scene.frame.points.triangles[i] == no_triangle) continue;
      ratio += static_cast<double>(irradiance[i]) / expected(scene, i, 2.5);
      ++seen;
    }
    EXPECT_NEAR(ratio / seen, 1, 0.05) << rays << " rays";
  }
}

INSTANTIATE_TEST_SUITE_P(Packings, Sampler, ::testing::Values(Packing::pixel, Packing::tile),
                         [](const auto& info) { return packing_name(info.param); });

}  // namespace
}  // namespace tenebra::bench
