#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"
#include "shadow/mask.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;

const ViewRays pinhole{.eye = {0, 0, 5}, .d0 = {-1, 1, -2}, .dx = {0.25f, 0, 0}, .dy = {0, -0.25f, 0}};

VisiblePoints points_of(std::vector<std::uint32_t> ids, int width, int height, const ViewRays& view,
                        const std::vector<vec3>& corners) {
  const std::vector<glm::uvec3> triangles{{0, 1, 2}};
  VisiblePoints points;
  compute_visible_points(ids, width, height, view, {corners, triangles, {}}, points);
  return points;
}

TEST(VisiblePoints, LieWhereThePixelsRayMeetsThePlane) {
  // Plane z = 1, eye at z = 5: t = 2 along (x, y, -2).
  const auto points =
      points_of(std::vector<std::uint32_t>(64, 0), 8, 8, pinhole, {{-50, -50, 1}, {50, -50, 1}, {0, 50, 1}});
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const dvec3 expected(2 * (-1 + 0.25 * (x + 0.5)), 2 * (1 - 0.25 * (y + 0.5)), 1);
      EXPECT_EQ(points.positions[8 * y + x], expected) << x << ' ' << y;
    }
  }
}

TEST(VisiblePoints, OrthographicRaysStartBesideEachOther) {
  ViewRays view{
      .eye = {-1, 1, 5}, .d0 = {0, 0, -1}, .dx = {0.25f, 0, 0}, .dy = {0, -0.25f, 0}, .orthographic = true};
  const auto points =
      points_of(std::vector<std::uint32_t>(64, 0), 8, 8, view, {{-50, -50, 1}, {50, -50, 1}, {0, 50, 1}});
  EXPECT_EQ(points.positions[9], dvec3(-1 + 0.375, 1 - 0.375, 1));
}

TEST(VisiblePoints, IdsThatNameNothingBecomeNoTriangle) {
  const auto points =
      points_of({no_triangle, 1, 77, 0}, 2, 2, pinhole, {{-50, -50, 1}, {50, -50, 1}, {0, 50, 1}});
  EXPECT_EQ(points.triangles, (std::vector<std::uint32_t>{no_triangle, no_triangle, no_triangle, 0}));
}

// A rasteriser's id may lie just outside of its triangle: the point is moved onto its border.
TEST(VisiblePoints, AreClampedIntoTheirTriangle) {
  const std::vector<vec3> corners{{0, 0, 1}, {0.3f, 0, 1}, {0, 0.3f, 1}};
  const auto points = points_of(std::vector<std::uint32_t>(64, 0), 8, 8, pinhole, corners);
  for (const dvec3& p : points.positions) {
    EXPECT_GE(p.x, -1e-15);
    EXPECT_GE(p.y, -1e-15);
    EXPECT_LE(p.x + p.y, 0.3f * (1 + 1e-15));
    EXPECT_NEAR(p.z, 1, 1e-15);
  }
}

// Edge-on planes, rays that point away, needles of zero area: finite points in the triangle's box.
TEST(VisiblePoints, AreFiniteForDegenerateTriangles) {
  testing::Random random(21);
  for (int i = 0; i < 2000; ++i) {
    std::vector<vec3> corners{vec3(random.grid(2)), vec3(random.grid(2)), vec3(random.grid(2))};
    ViewRays view = pinhole;
    view.eye = vec3(random.grid(2));
    const auto points = points_of(std::vector<std::uint32_t>(64, 0), 8, 8, view, corners);
    for (const dvec3& p : points.positions) {
      for (int k = 0; k < 3; ++k) {
        const double low = std::min({corners[0][k], corners[1][k], corners[2][k]});
        const double high = std::max({corners[0][k], corners[1][k], corners[2][k]});
        ASSERT_GE(p[k], low - 1e-12) << "case " << i;
        ASSERT_LE(p[k], high + 1e-12) << "case " << i;
      }
    }
  }
}

TEST(VisiblePoints, HaveTheSameBitsOnAnyNumberOfThreads) {
  testing::Random random(22);
  const std::vector<vec3> corners{{-50, -50, 1.3f}, {50, -40, 0.7f}, {0, 50, 1.1f}};
  std::vector<std::uint32_t> ids(173 * 91, 0);
  const VisiblePoints expected = points_of(ids, 173, 91, pinhole, corners);
  for (const int threads : {1, 2, 3, 8}) {
    with_threads(threads,
                 [&] { EXPECT_EQ(points_of(ids, 173, 91, pinhole, corners).positions, expected.positions); });
  }
}

}  // namespace
}  // namespace tenebra
