#include "ao/cast/ray_pattern.h"

#include <gtest/gtest.h>

#include "support/seeded_random.h"

namespace tenebra {
namespace {

std::vector<glm::dvec3> directions(const ao::RayPattern& pattern) {
  std::vector<glm::dvec3> all;
  for (const ao::RayPattern::Batch& batch : pattern.batches)
    for (int i = 0; i < trees::batch_size; ++i) all.push_back({batch.x[i], batch.y[i], batch.z[i]});
  return all;
}

TEST(RayPattern, IsUnitAndFilledUpWithZeros) {
  for (const int rays : {1, 5, 16, 17, 64, 100, 256}) {
    const ao::RayPattern pattern = ao::make_ray_pattern(rays);
    const auto all = directions(pattern);
    ASSERT_EQ(all.size(), static_cast<std::size_t>((rays + 15) / 16 * 16));
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_NEAR(glm::length(all[i]), i < static_cast<std::size_t>(rays) ? 1 : 0, 1e-6) << rays << " " << i;
      EXPECT_GE(all[i].z, 0) << rays << " " << i;
    }
  }
}

// Of cosine-weighted directions the mean of z is 2/3, of z^2 1/2, of x and y 0, of x^2 and y^2 1/4.
TEST(RayPattern, IsCosineWeighted) {
  for (const int rays : {64, 100, 256, 4096}) {
    glm::dvec3 mean(0), square(0);
    for (const glm::dvec3& d : directions(ao::make_ray_pattern(rays)))
      mean += d / double(rays), square += d * d / double(rays);
    const double bound = 2.0 / rays;
    EXPECT_NEAR(mean.z, 2.0 / 3, bound) << rays;
    EXPECT_NEAR(mean.x, 0, bound) << rays;
    EXPECT_NEAR(mean.y, 0, bound) << rays;
    EXPECT_NEAR(square.z, 0.5, bound) << rays;
    EXPECT_NEAR(square.x, 0.25, bound) << rays;
  }
}

TEST(RayPattern, AxesBelongToThePlace) {
  testing::Random random(7);
  int turned = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 n(random.direction());
    const glm::dvec3 p = random.in_cube(10);
    const ao::RayAxes a = ao::turned_axes(n, p, 0.5), b = ao::turned_axes(n, p + random.in_cube(1e-12), 0.5);
    EXPECT_LT(glm::length(a.x - b.x), 1e-6f);
    EXPECT_NEAR(glm::dot(glm::cross(a.x, a.y), a.z), 1, 1e-5);
    EXPECT_NEAR(glm::dot(a.x, n), 0, 1e-5);
    turned += glm::length(a.x - ao::turned_axes(n, p + glm::dvec3(3), 0.5).x) > 0.1f;
  }
  EXPECT_GT(turned, 450);
}

// A wall at a round coordinate is not split between two cells by the rounding of its points.
TEST(RayPattern, AxesDoNotFlickerOnRoundCoordinates) {
  const ao::RayAxes a = ao::turned_axes({0, 1, 0}, {0.1, 1e-17, 2.2}, 0.25),
                    b = ao::turned_axes({0, 1, 0}, {0.1, -1e-17, 2.2}, 0.25);
  EXPECT_EQ(a.x, b.x);
  const ao::RayAxes c = ao::turned_axes({0, 1, 0}, {0.1, 1 - 1e-16, 2.2}, 0.25),
                    d = ao::turned_axes({0, 1, 0}, {0.1, 1, 2.2}, 0.25);
  EXPECT_EQ(c.x, d.x);
}

TEST(RayPattern, NoRayGoesBelowTheFace) {
  const ao::RayPattern pattern = ao::make_ray_pattern(64);
  const glm::vec3 face(0, 1, 0), normal = glm::normalize(glm::vec3(1, 0.4f, 0.2f)), origin(3, 4, 5);
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    std::vector<trees::RayBatch> rays(pattern.batches.size());
    ao::fan_kernels(level).spread(pattern, ao::turned_axes(normal, {}, 1), face, origin, rays.data());
    for (const trees::RayBatch& batch : rays) {
      for (int i = 0; i < trees::batch_size; ++i) {
        EXPECT_GE(batch.dy[i], 0);
        EXPECT_NEAR(glm::length(batch.direction(i)), 1, 1e-5);
        EXPECT_GE(glm::dot(batch.direction(i), normal), -1e-5);
        EXPECT_EQ(batch.origin(i), origin);
      }
    }
    std::vector<trees::RayBatch> scalar(pattern.batches.size());
    ao::fan_kernels(SimdLevel::scalar)
        .spread(pattern, ao::turned_axes(normal, {}, 1), face, origin, scalar.data());
    for (std::size_t b = 0; b < rays.size(); ++b)
      for (int i = 0; i < trees::batch_size; ++i) EXPECT_EQ(rays[b].direction(i), scalar[b].direction(i));
  }
}

TEST(RayPattern, FallOffIsLinearAndEndsAtTheReach) {
  float distances[32];
  for (int i = 0; i < 32; ++i) distances[i] = static_cast<float>(i) / 8;  // 0 .. 31/8
  float expected = 0;
  for (int i = 0; i < 16; ++i) expected += 1 - static_cast<float>(i) / 16;
  EXPECT_NEAR(ao::fan_kernels(SimdLevel::automatic).fall_off(distances, 2, 2), expected, 1e-5);
  EXPECT_EQ(ao::fan_kernels(SimdLevel::automatic).fall_off(distances, 2, 2),
            ao::fan_kernels(SimdLevel::scalar).fall_off(distances, 2, 2));
}

}  // namespace
}  // namespace tenebra
