// Sixteen rays from one point against one ray at a time.
#include "trees/fan_caster.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/seeded_random.h"
#include "support/soup.h"

namespace tenebra {
namespace {

using testing::Random;

constexpr float farthest = std::numeric_limits<float>::max();

struct Cloud {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

Cloud cloud(std::uint64_t seed, int count, double size) {
  Random random(seed);
  Cloud out;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 at = random.in_cube(1);
    for (int k = 0; k < 3; ++k) out.positions.push_back(glm::vec3(at + random.in_cube(size)));
    const auto base = static_cast<std::uint32_t>(3 * i);
    out.triangles.push_back({base, base + 1, base + 2});
  }
  return out;
}

trees::RayBatch fan(Random& random, glm::vec3 origin) {
  trees::RayBatch rays;
  for (int i = 0; i < trees::batch_size; ++i) rays.set(i, origin, glm::vec3(random.direction()));
  return rays;
}

TEST(FanCaster, AgreesWithOneRayAtATime) {
  for (const int count : {1, 7, 9, 100, 3000}) {
    const Cloud cloud = tenebra::cloud(static_cast<std::uint64_t>(count), count, count < 50 ? 1.5 : 0.2);
    const trees::TriangleBvh bvh = trees::build_triangle_bvh(cloud.positions, cloud.triangles);
    Random random(5);
    int hits = 0;
    for (int n = 0; n < 200; ++n) {
      const trees::RayBatch rays = fan(random, glm::vec3(random.in_cube(1.5)));
      const float reach = n % 2 == 0 ? 0.4f : 100.0f;
      float distance[trees::batch_size], facing[trees::batch_size];
      std::fill_n(distance, trees::batch_size, reach);
      trees::closest_fans(SimdLevel::automatic)(bvh, {&rays, 1}, distance, facing);
      for (int i = 0; i < trees::batch_size; ++i) {
        const trees::CasterHit hit =
            trees::bvh_kernels(SimdLevel::automatic)
                .closest(bvh, {rays.origin(i), rays.direction(i), 0, reach, trees::no_caster});
        if (hit.triangle == trees::no_caster) {
          EXPECT_EQ(distance[i], reach);
          EXPECT_EQ(facing[i], 0);
          continue;
        }
        ++hits;
        EXPECT_NEAR(distance[i], hit.distance, 1e-4 * (1 + hit.distance));
        const glm::uvec3 t = cloud.triangles[hit.triangle];
        const glm::vec3 a = cloud.positions[t.x];
        const glm::vec3 normal = glm::cross(cloud.positions[t.y] - a, cloud.positions[t.z] - a);
        EXPECT_EQ(facing[i] > 0, glm::dot(normal, rays.direction(i)) < 0) << count << " " << n << " " << i;
      }
    }
    EXPECT_GT(hits, 0) << count;
  }
}

TEST(FanCaster, SameBitsForEveryInstructionSet) {
  const Cloud cloud = tenebra::cloud(3, 500, 0.3);
  const trees::TriangleBvh bvh = trees::build_triangle_bvh(cloud.positions, cloud.triangles);
  Random random(11);
  for (int n = 0; n < 100; ++n) {
    const trees::RayBatch rays = fan(random, glm::vec3(random.in_cube(1)));
    float expected[trees::batch_size], expected_facing[trees::batch_size];
    std::fill_n(expected, trees::batch_size, 3.0f);
    trees::closest_fans(SimdLevel::scalar)(bvh, {&rays, 1}, expected, expected_facing);
    for (const SimdLevel level : {SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      float distance[trees::batch_size], facing[trees::batch_size];
      std::fill_n(distance, trees::batch_size, 3.0f);
      trees::closest_fans(level)(bvh, {&rays, 1}, distance, facing);
      for (int i = 0; i < trees::batch_size; ++i) {
        EXPECT_EQ(distance[i], expected[i]) << simd_level_name(level);
        EXPECT_EQ(facing[i], expected_facing[i]) << simd_level_name(level);
      }
    }
  }
}

// Six fans at once, then each of their rays by itself: small triangles and large ones.
TEST(FanCaster, WhatARayFindsDoesNotDependOnTheOthers) {
  for (const double size : {0.02, 0.5}) {
    const Cloud cloud = tenebra::cloud(9, 4000, size);
    const trees::TriangleBvh bvh = trees::build_triangle_bvh(cloud.positions, cloud.triangles);
    constexpr std::size_t fans = 6, rays = fans * trees::batch_size;
    Random random(21);
    for (int n = 0; n < 50; ++n) {
      const glm::vec3 origin(random.in_cube(1));
      trees::RayBatch together[fans];
      for (trees::RayBatch& fan : together) fan = tenebra::fan(random, origin);
      float distance[rays], facing[rays];
      std::fill_n(distance, rays, 0.7f);
      trees::closest_fans(SimdLevel::automatic)(bvh, {together, fans}, distance, facing);
      for (std::size_t i = 0; i < rays; ++i) {
        trees::RayBatch alone{};
        for (int k = 0; k < trees::batch_size; ++k) alone.set(k, origin, glm::vec3(0.0f));
        alone.set(3, origin,
                  together[i / trees::batch_size].direction(static_cast<int>(i % trees::batch_size)));
        float far[trees::batch_size], side[trees::batch_size];
        std::fill_n(far, trees::batch_size, 0.7f);
        trees::closest_fans(SimdLevel::automatic)(bvh, {&alone, 1}, far, side);
        EXPECT_EQ(far[3], distance[i]) << size << " " << n << " " << i;
        EXPECT_EQ(side[3], facing[i]) << size << " " << n << " " << i;
      }
    }
  }
}

// An object half as large as its world: its rays are twice as long in its own space.
TEST(FanCaster, DirectionsMayHaveAnyLength) {
  const Cloud cloud = tenebra::cloud(4, 500, 0.2);
  const trees::TriangleBvh bvh = trees::build_triangle_bvh(cloud.positions, cloud.triangles);
  Random random(7);
  for (int n = 0; n < 50; ++n) {
    trees::RayBatch rays = fan(random, glm::vec3(random.in_cube(1))), longer = rays;
    for (int i = 0; i < trees::batch_size; ++i) longer.set(i, rays.origin(i), 4.0f * rays.direction(i));
    float distance[trees::batch_size], quarter[trees::batch_size];
    std::fill_n(distance, trees::batch_size, 2.0f);
    std::fill_n(quarter, trees::batch_size, 0.5f);
    trees::closest_fans(SimdLevel::automatic)(bvh, {&rays, 1}, distance, nullptr);
    trees::closest_fans(SimdLevel::automatic)(bvh, {&longer, 1}, quarter, nullptr);
    for (int i = 0; i < trees::batch_size; ++i) EXPECT_EQ(4 * quarter[i], distance[i]) << n << " " << i;
  }
}

// Rays through the shared edges of a closed body from within: none gets out. (Exactly through a vertex, one
// in some hundreds does: the planes of its edges are rounded each by itself.)
TEST(FanCaster, LeavesNoGapBetweenNeighbours) {
  Random random(2);
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  const std::uint32_t n = 12;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const double a = 6.283185307179586 * i / n, b = 3.141592653589793 * j / n;
      const glm::dvec3 d(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
      positions.push_back(glm::vec3(j == 0 ? glm::dvec3(0, 1, 0) : j == n ? glm::dvec3(0, -1, 0) : d));
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * n + i, b = j * n + (i + 1) % n;
      if (j > 0) triangles.push_back({a, b, b + n});
      if (j + 1 < n) triangles.push_back({a, b + n, a + n});
    }
  const trees::TriangleBvh bvh = trees::build_triangle_bvh(positions, triangles);
  for (int round = 0; round < 300; ++round) {
    const glm::vec3 origin(random.in_cube(0.3));
    trees::RayBatch rays;
    for (int i = 0; i < trees::batch_size; ++i) {
      const glm::uvec3 t = triangles[random.index(static_cast<std::uint32_t>(triangles.size()))];
      const auto s = static_cast<float>(random.in(0.01, 0.99));
      rays.set(i, origin, positions[t.x] + s * (positions[t.y] - positions[t.x]) - origin);
    }
    float distance[trees::batch_size];
    std::fill_n(distance, trees::batch_size, farthest);
    trees::closest_fans(SimdLevel::automatic)(bvh, {&rays, 1}, distance, nullptr);
    for (int i = 0; i < trees::batch_size; ++i) EXPECT_LT(distance[i], 1.01f) << round << " " << i;
  }
}

TEST(FanCaster, AnEmptyTreeAndRaysWithoutDirectionMeetNothing) {
  const trees::TriangleBvh empty = trees::build_triangle_bvh({}, {});
  const Cloud cloud = tenebra::cloud(3, 50, 0.5);
  const trees::TriangleBvh bvh = trees::build_triangle_bvh(cloud.positions, cloud.triangles);
  trees::RayBatch rays{};
  float distance[trees::batch_size];
  std::fill_n(distance, trees::batch_size, 2.0f);
  trees::closest_fans(SimdLevel::automatic)(empty, {&rays, 1}, distance, nullptr);
  trees::closest_fans(SimdLevel::automatic)(bvh, {&rays, 1}, distance, nullptr);
  for (const float d : distance) EXPECT_EQ(d, 2.0f);
}

}  // namespace
}  // namespace tenebra
