// The node tests promise: a rejected triangle blocks no ray of the node, a covering one blocks all of them;
// on every instruction set, for narrow and for very wide cones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "shadow/cone_tree/traverse.h"
#include "shadow/decision/decide.h"
#include "support/parameter_names.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;
using testing::Random;

constexpr int ray_count = 4 * shadow::packet_size;

// Sixty-four rays around `centre` as seen from the source, and one triangle aimed at them.
struct Arrangement {
  std::vector<vec3> corners;
  std::vector<glm::uvec3> triangles{{0, 1, 2}};
  std::vector<dvec3> points;
  shadow::ShadowRays rays;
  shadow::RaySource source;
};

Arrangement arrangement(Random& random, double spread, bool directional) {
  Arrangement a;
  const dvec3 axis = random.direction();
  ShadowLight light{.directional = directional, .position = vec3(random.in_cube(3)), .to_light = vec3(-axis)};
  a.source = shadow::ray_source(light);
  const double distance = std::pow(10.0, random.in(-1, 1));
  const auto beside =
      [&](double wider) {  // a place `wider` times the spread away from the axis, as seen from the light
        return axis + wider * spread * dvec3(random.in_cube(1));
      };
  for (int i = 0; i < ray_count; ++i) {
    const dvec3 d = beside(1);
    const double length = distance * random.in(0.9, 1.1);
    a.points.push_back(a.source.origin +
                       (directional ? d * distance + length * axis : d * (length / glm::length(d))));
    a.rays.pixels.push_back(static_cast<std::uint32_t>(i));
    a.rays.triangles.push_back(no_triangle);
  }
  const double depth = distance * (random.index(4) == 0 ? random.in(0.9, 1.1) : random.in(0.3, 0.9));
  for (int k = 0; k < 3; ++k) {
    const dvec3 d = beside(std::pow(10.0, random.in(-0.5, 1.0)));
    const double length = depth * random.in(0.8, 1.2);
    a.corners.push_back(vec3(a.source.origin + (directional ? d * distance + length * axis : d * length)));
  }
  return a;
}

// The arrangement's tree of rays, to be traversed by its triangle.
struct RayTree {
  TriangleView view;
  shadow::TriangleSet set;
  shadow::ConeTree tree;
  shadow::Traversal traversal;

  RayTree(const Arrangement& a, bool spheres) : view{a.corners, a.triangles, {}} {
    shadow::build_triangle_set(view, a.source, {.contact = ContactRule::none}, set);
    shadow::build_cone_tree(a.rays, a.points, a.source, SimdLevel::automatic, tree);
    traversal = {{spheres, true, a.source.directional},
                 &set,
                 &a.rays,
                 &tree,
                 &a.source,
                 &view,
                 a.points,
                 ContactRule::none};
  }
  RayTree(const RayTree&) = delete;
  RayTree& operator=(const RayTree&) = delete;
};

void check(const Arrangement& a, const shadow::TraversalKernels& kernels, bool spheres) {
  const RayTree rays(a, spheres);
  if (rays.set.planes.empty()) return;

  TraceStats stats;
  std::vector<bool> blocked(ray_count);
  for (int i = 0; i < ray_count; ++i) {
    blocked[i] = shadow::decide(rays.set.planes[0], a.points[i], no_triangle, a.source, rays.view,
                                ContactRule::none, stats);
  }
  const std::uint32_t place = 0;
  for (std::size_t level = 0; level < 2; ++level) {
    shadow::ConeTree fresh = rays.tree;
    shadow::Traversal on_fresh = rays.traversal;
    on_fresh.tree = &fresh;
    std::uint32_t storage[4][2];
    std::uint32_t* out[4] = {storage[0], storage[1], storage[2], storage[3]};
    std::size_t size[4];
    kernels.filter(on_fresh, level, 0, {&place, 1}, out, size, stats);
    for (int lane = 0; lane < (level == 0 ? 4 : 1); ++lane) {
      const int first = lane * shadow::packet_size,
                last = level == 0 ? first + shadow::packet_size : ray_count;
      const auto hits = std::count(blocked.begin() + first, blocked.begin() + last, true);
      const bool covered = fresh.levels[level][0].c[lane] < 0;
      if (covered) {
        ASSERT_EQ(hits, last - first) << "covered, but some ray is free; level " << level << " lane " << lane;
      } else if (size[lane] == 0) {
        ASSERT_EQ(hits, 0) << "rejected, but some ray is blocked; level " << level << " lane " << lane;
      }
    }
  }
}

struct RootVerdict {
  bool rejected, covered;
};

// The root of the tree (level 1 has one node) against the arrangement's triangle.
RootVerdict filter_once(const Arrangement& a, const shadow::TraversalKernels& kernels) {
  const RayTree rays(a, false);
  const std::uint32_t place = 0;
  std::uint32_t storage[4][2];
  std::uint32_t* out[4] = {storage[0], storage[1], storage[2], storage[3]};
  std::size_t size[4];
  TraceStats stats;
  kernels.filter(rays.traversal, 1, 0, {&place, 1}, out, size, stats);
  const bool covered = rays.tree.levels[1][0].c[0] < 0;
  return {!covered && size[0] == 0, covered};
}

// A triangle that lies outside of the cone but for its edge, which touches the outermost ray: decided by the
// last bits of the bounds.
Arrangement touching_arrangement(Random& random, double spread, bool directional) {
  Arrangement a = arrangement(random, spread, directional);
  const auto seen = [&](const dvec3& p) {
    const dvec3 q = p - a.source.origin;
    return directional ? q - glm::dot(q, a.source.travel) * a.source.travel : glm::normalize(q);
  };
  dvec3 low(INFINITY), high(-INFINITY);
  for (const dvec3& p : a.points) low = glm::min(low, seen(p)), high = glm::max(high, seen(p));
  const dvec3 axis = 0.5 * (low + high);
  const dvec3 outermost =
      *std::max_element(a.points.begin(), a.points.end(), [&](const dvec3& p, const dvec3& q) {
        return glm::distance(seen(p), axis) < glm::distance(seen(q), axis);
      });
  const dvec3 outwards = seen(outermost) - axis;
  const dvec3 travel = directional ? a.source.travel : glm::normalize(outermost - a.source.origin);
  const dvec3 along = glm::cross(travel, outwards);
  const dvec3 on_ray =
      directional ? outermost - 0.5 * travel : a.source.origin + 0.5 * (outermost - a.source.origin);
  const double size = 0.5 * std::pow(10.0, random.in(0, 1));
  a.corners = {vec3(on_ray + size * along), vec3(on_ray - size * random.in(0.5, 1) * along),
               vec3(on_ray + size * (outwards + random.in(-0.3, 0.3) * along))};
  return a;
}

class NodeTests : public ::testing::TestWithParam<SimdLevel> {};

TEST_P(NodeTests, NeverRejectABlockerNorAcceptAGap) {
  // Kernels of a vector level run only where the processor has it.
  if (!simd_level_supported(GetParam()))
    GTEST_SKIP() << "this machine or this build lacks " << simd_level_name(GetParam());
  const shadow::TraversalKernels kernels = shadow::traversal_kernels(GetParam());
  for (const bool directional : {false, true}) {
    for (const double spread : {1e-6, 1e-4, 1e-2, 0.3, 1.0, 3.0, 30.0}) {
      for (const bool spheres : {false, true}) {
        for (std::uint64_t seed = 0; seed < 3000; ++seed) {
          Random random(seed);
          check(arrangement(random, spread, directional), kernels, spheres);
          check(touching_arrangement(random, spread, directional), kernels, spheres);
          ASSERT_FALSE(HasFatalFailure()) << "seed " << seed << " spread " << spread << " directional "
                                          << directional << " spheres " << spheres;
        }
      }
    }
  }
}

// The other side of the bounds: not so cautious as to be of no use. Corners in units of the spread, across
// the axis.
RootVerdict verdict_on(double spread, bool directional, const std::array<glm::dvec2, 3>& corners,
                       const shadow::TraversalKernels& kernels) {
  Random random(5);
  Arrangement a;
  a.source = shadow::ray_source({.directional = directional, .position = {0, 0, 0}, .to_light = {0, 0, 1}});
  for (int i = 0; i < ray_count; ++i) {
    a.points.push_back(10.0 * dvec3(spread * random.in(-0.7, 0.7), spread * random.in(-0.7, 0.7), -1));
    a.rays.pixels.push_back(static_cast<std::uint32_t>(i));
    a.rays.triangles.push_back(no_triangle);
  }
  for (const glm::dvec2& c : corners)
    a.corners.push_back((directional ? 10.0 : 5.0) *
                        dvec3(spread * c.x, spread * c.y, directional ? -0.5 : -1));
  return filter_once(a, kernels);
}

TEST(NodeTestsSlack, ATriangleThatPassesBesideIsRejected) {
  for (const double spread : {1e-5, 1e-4, 1e-3, 1e-2, 0.1}) {
    for (const bool directional : {false, true}) {
      const shadow::TraversalKernels kernels = shadow::traversal_kernels(SimdLevel::automatic);
      EXPECT_TRUE(verdict_on(spread, directional, {{{1.3, -3}, {4, 0}, {1.3, 3}}}, kernels).rejected)
          << spread << directional;
      EXPECT_TRUE(verdict_on(spread, directional, {{{-30, -1.3}, {30, -1.3}, {0, -40}}}, kernels).rejected)
          << spread << directional;
    }
  }
}

// Figure 4 of the paper: a sharp corner points at the cone and stops short of it. No edge plane separates the
// two.
TEST(NodeTestsSlack, TheTriangleShadowIsRejected) {
  for (const double spread : {1e-4, 1e-3, 1e-2, 0.1}) {
    for (const bool directional : {false, true}) {
      const shadow::TraversalKernels kernels = shadow::traversal_kernels(SimdLevel::automatic);
      EXPECT_TRUE(verdict_on(spread, directional, {{{1.5, 0}, {40, 4}, {40, -4}}}, kernels).rejected)
          << spread << directional;
    }
  }
}

TEST(NodeTestsSlack, ALargeTriangleInFrontCovers) {
  for (const double spread : {1e-5, 1e-4, 1e-3, 1e-2, 0.1}) {
    for (const bool directional : {false, true}) {
      const shadow::TraversalKernels kernels = shadow::traversal_kernels(SimdLevel::automatic);
      EXPECT_TRUE(verdict_on(spread, directional, {{{-4, -3}, {4, -3}, {0, 5}}}, kernels).covered)
          << spread << directional;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryInstructionSet, NodeTests,
                         ::testing::Values(SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2,
                                           SimdLevel::avx512),
                         [](const auto& info) { return std::string(simd_level_name(info.param)); });

// The sphere variants are not to lose by a larger sphere than the earlier work had.
TEST(NodeBounds, TheSphereOfATriangleIsTheSmallest) {
  Random random(23);
  const shadow::RaySource source =
      shadow::ray_source({.directional = true, .position = {}, .to_light = vec3(0, 0, 1)});
  int acute = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<vec3> corners(3);
    for (vec3& corner : corners) corner = vec3(random.in_cube(1));
    if (i == 0) corners = {{1, 0, 0}, {-0.5f, 0.8660254f, 0}, {-0.5f, -0.8660254f, 0}};
    const std::vector<glm::uvec3> triangles{{0, 1, 2}};
    shadow::TriangleSet set;
    shadow::build_triangle_set({corners, triangles, {}}, source, {.contact = ContactRule::none}, set);
    if (set.bounds.empty()) continue;
    std::array<double, 3> edges{};
    for (std::size_t k = 0; k < 3; ++k)
      edges[k] = glm::length(dvec3(corners[k]) - dvec3(corners[(k + 1) % 3]));
    std::sort(edges.begin(), edges.end());
    const dvec3 a = corners[0];
    const double twice_area = glm::length(glm::cross(dvec3(corners[1]) - a, dvec3(corners[2]) - a));
    const bool is_acute = edges[0] * edges[0] + edges[1] * edges[1] > edges[2] * edges[2];
    const double least = is_acute ? edges[0] * edges[1] * edges[2] / (2 * twice_area) : edges[2] / 2;
    acute += is_acute ? 1 : 0;
    EXPECT_GE(set.bounds[0].sphere_chord, least * (1 - 1e-12)) << i;
    EXPECT_LE(set.bounds[0].sphere_chord, least * (1 + 1e-6)) << i;
  }
  EXPECT_GT(acute, 300);
}

}  // namespace
}  // namespace tenebra
