// The caster finds what brute force in double finds, on every instruction set, and nothing disturbs it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/samples.h"
#include "support/seeded_random.h"
#include "trees/triangle_bvh.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;
using testing::Random;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr SimdLevel levels[] = {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512};

struct Triangles {
  std::vector<vec3> positions;
  std::vector<glm::uvec3> triangles;

  void add(vec3 a, vec3 b, vec3 c) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), {a, b, c});
    triangles.emplace_back(first, first + 1, first + 2);
  }
  trees::TriangleBvh bvh() const { return trees::build_triangle_bvh(positions, triangles); }
};

Triangles random_triangles(Random& random, int count, double size) {
  Triangles result;
  for (int i = 0; i < count; ++i) {
    const dvec3 at = random.in_cube(1);
    result.add(vec3(at + random.in_cube(size)), vec3(at + random.in_cube(size)),
               vec3(at + random.in_cube(size)));
  }
  return result;
}

/// t of the hit with one triangle in double; infinity: none. `margin`: how near to an edge, in barycentric
/// coordinates, the ray passes.
double hit_in_double(const Triangles& set, std::size_t id, const trees::CasterRay& ray, double& margin) {
  const glm::uvec3 index = set.triangles[id];
  const dvec3 a(set.positions[index.x]), b(set.positions[index.y]), c(set.positions[index.z]);
  const dvec3 o(ray.origin), d(ray.direction), n = cross(b - a, c - a);
  const double facing = dot(n, d), t = dot(n, a - o) / facing;
  const dvec3 p = o + t * d;
  const double area = dot(n, n);
  const double u = dot(cross(c - b, p - b), n) / area, v = dot(cross(a - c, p - c), n) / area;
  const double inside = std::min({u, v, 1 - u - v});
  margin = std::abs(inside);
  return inside >= 0 && t > ray.from && t < ray.to ? t : HUGE_VAL;
}

TEST(TriangleBvh, FindsWhatBruteForceFinds) {
  Random random(1);
  int hits = 0;
  for (const int count : {1, 7, 8, 9, 64, 500, 3000}) {
    const Triangles set = random_triangles(random, count, count < 100 ? 1.0 : 0.2);
    const trees::TriangleBvh bvh = set.bvh();
    ASSERT_EQ(bvh.triangles, static_cast<std::size_t>(count));
    for (int i = 0; i < 200; ++i) {
      trees::CasterRay ray{vec3(random.in_cube(1.5)), vec3(random.direction())};
      if (i % 4 == 1) ray.to = static_cast<float>(random.in(0, 2));
      if (i % 4 == 2) ray.from = static_cast<float>(random.in(0, 1));
      if (i % 4 == 3) ray.skip = random.index(static_cast<std::uint32_t>(count));
      double nearest = HUGE_VAL, margin = 1, closest_call = 1;
      for (std::size_t id = 0; id < set.triangles.size(); ++id) {
        if (id == ray.skip) continue;
        nearest = std::min(nearest, hit_in_double(set, id, ray, margin));
        closest_call = std::min(closest_call, margin);
      }
      if (closest_call < 1e-5) continue;
      for (const SimdLevel level : levels) {
        if (!simd_level_supported(level)) continue;
        const trees::BvhKernels kernels = trees::bvh_kernels(level);
        const trees::CasterHit hit = kernels.closest(bvh, ray);
        EXPECT_EQ(kernels.any(bvh, ray), nearest < HUGE_VAL);
        if (nearest < HUGE_VAL) {
          EXPECT_NEAR(hit.distance, nearest, 1e-4) << count << " " << i;
        } else {
          EXPECT_EQ(hit.distance, infinity);
          EXPECT_EQ(hit.triangle, trees::no_caster);
        }
      }
      hits += nearest < HUGE_VAL;
    }
  }
  EXPECT_GT(hits, 250);
}

TEST(TriangleBvh, GivesTheSameBitsOnEveryInstructionSet) {
  Random random(2);
  const Triangles set = random_triangles(random, 2000, 0.3);
  const trees::TriangleBvh bvh = set.bvh();
  for (int i = 0; i < 500; ++i) {
    trees::RayBatch rays;
    for (int k = 0; k < trees::batch_size; ++k)
      rays.set(k, vec3(random.in_cube(2)), vec3(random.direction()));
    float expected[trees::batch_size];
    std::fill(expected, expected + trees::batch_size, infinity);
    trees::bvh_kernels(SimdLevel::scalar).closest_batch(bvh, rays, expected);
    for (const SimdLevel level : levels) {
      if (!simd_level_supported(level)) continue;
      float distance[trees::batch_size];
      std::fill(distance, distance + trees::batch_size, infinity);
      trees::bvh_kernels(level).closest_batch(bvh, rays, distance);
      for (int k = 0; k < trees::batch_size; ++k) {
        EXPECT_EQ(distance[k], expected[k]);
        const trees::CasterHit hit =
            trees::bvh_kernels(level).closest(bvh, {rays.origin(k), rays.direction(k)});
        EXPECT_EQ(hit.distance, expected[k]);
      }
    }
  }
}

TEST(TriangleBvh, LeavesNoGapBetweenNeighbours) {
  // A closed sphere of fans seen from inside, with rays aimed at its vertices and edges.
  Triangles sphere;
  constexpr int rings = 12, sectors = 24;
  const auto at = [](int ring, int sector) {
    if (ring % rings == 0) return vec3(0, ring == 0 ? 1 : -1, 0);
    const double theta = ring * M_PI / rings, phi = (sector % sectors) * 2 * M_PI / sectors;
    return vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      sphere.add(at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1));
      sphere.add(at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1));
    }
  const trees::TriangleBvh bvh = sphere.bvh();
  Random random(3);
  for (const trees::BvhKernels& kernels :
       {trees::bvh_kernels(SimdLevel::scalar), trees::bvh_kernels(SimdLevel::automatic)}) {
    for (int i = 0; i < 20000; ++i) {
      const vec3 origin(random.in_cube(0.5));
      const vec3 a = sphere.positions[random.index(static_cast<std::uint32_t>(sphere.positions.size()))];
      const std::uint32_t base = random.index(static_cast<std::uint32_t>(sphere.triangles.size())) * 3;
      const vec3 b = sphere.positions[base], c = sphere.positions[base + 1];
      const vec3 target = i % 2 ? a : b + static_cast<float>(random.unit()) * (c - b);
      EXPECT_TRUE(kernels.any(bvh, {origin, target - origin}));
    }
  }
}

TEST(TriangleBvh, LeavesOutWhatIsNoTriangle) {
  Triangles set;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  set.add({nan, 0, 0}, {1, 0, 0}, {0, 1, 0});
  set.add({0, 0, 0}, {infinity, 0, 0}, {0, 1, 0});
  set.add({0, 0, 0}, {2e18f, 0, 0}, {0, 1, 0});
  set.add({1, 1, 1}, {1, 1, 1}, {1, 1, 1});
  set.add({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  set.triangles.emplace_back(0, 1, 4000000000u);
  EXPECT_EQ(set.bvh().triangles, 0u);
  EXPECT_EQ(trees::bvh_kernels(SimdLevel::automatic).closest(set.bvh(), {{0, 0, 1}, {0, 0, -1}}).distance,
            infinity);
  set.add({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  const trees::TriangleBvh bvh = set.bvh();
  EXPECT_EQ(bvh.triangles, 1u);
  const trees::CasterHit hit = trees::bvh_kernels(SimdLevel::automatic).closest(bvh, {{0, 0, 2}, {0, 0, -1}});
  EXPECT_EQ(hit.distance, 2.0f);
  EXPECT_EQ(hit.triangle, 6u);
}

TEST(TriangleBvh, SurvivesRaysThatAreNone) {
  Random random(4);
  const trees::TriangleBvh bvh = random_triangles(random, 300, 0.5).bvh();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, infinity, -infinity}) {
    for (int k = 0; k < 6; ++k) {
      trees::CasterRay ray{{0.1f, 0.2f, 0.3f}, {0.3f, 0.5f, -0.7f}};
      (k < 3 ? ray.origin[k] : ray.direction[k - 3]) = bad;
      EXPECT_EQ(trees::bvh_kernels(SimdLevel::automatic).closest(bvh, ray).distance, infinity);
    }
  }
  EXPECT_FALSE(trees::bvh_kernels(SimdLevel::automatic).any(bvh, {{0, 0, 0}, {0, 0, 0}}));
  EXPECT_FALSE(trees::bvh_kernels(SimdLevel::automatic).any(bvh, {{0, 0, 0}, {0, 0, 1}, nan, nan}));
}

TEST(TriangleBvh, HoldsWhateverTheSpread) {
  // A million triangles that coincide, and sizes that shrink by ten from one to the next: neither a deep tree
  // nor an endless one.
  Triangles same, shrinking;
  for (int i = 0; i < 5000; ++i) same.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (int i = 0; i < 2000; ++i) {
    const float s = static_cast<float>(std::pow(10.0, 17.0 - 0.02 * i));
    shrinking.add({s, 0, 0}, {s, s, 0}, {s, 0, s});
    shrinking.add({0, s, 0}, {s, s, 0}, {0, s, s});
    shrinking.add({0, 0, s}, {s, 0, s}, {0, s, s});
  }
  EXPECT_EQ(
      trees::bvh_kernels(SimdLevel::automatic).closest(same.bvh(), {{0.2f, 0.2f, 1}, {0, 0, -1}}).triangle,
      0u);
  const trees::TriangleBvh bvh = shrinking.bvh();
  EXPECT_GT(bvh.triangles, 3000u);
  EXPECT_TRUE(trees::bvh_kernels(SimdLevel::automatic).any(bvh, {{0, 0, 0}, {1, 0.2f, 0.2f}}));
}

TEST(TriangleBvh, AgreesWithEmbree) {
  Random random(5);
  const Triangles set = random_triangles(random, 5000, 0.1);
  const trees::TriangleBvh bvh = set.bvh();
  const testing::PeerTracer peer({set.positions, set.triangles, {}});
  int differ = 0, hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3 origin(random.in_cube(2)), direction(random.direction());
    const trees::CasterHit hit = trees::bvh_kernels(SimdLevel::automatic).closest(bvh, {origin, direction});
    differ += hit.triangle != peer.nearest(origin, direction);
    hits += hit.triangle != trees::no_caster;
  }
  EXPECT_GT(hits, 2000);
  EXPECT_LE(differ, 2);  // rays along an edge, within rounding
}

}  // namespace
}  // namespace tenebra
