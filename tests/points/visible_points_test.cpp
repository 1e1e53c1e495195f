#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <tenebra/hard_shadows.h>
#include "parallel/parallel.h"
#include "points/visible_run.h"
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

// Eight pixels at a time, by whatever instructions, and one by one: a picture one pixel wide has no runs.
TEST(VisiblePoints, HaveTheSameBitsAloneAndInRuns) {
  testing::Random random(91);
  int met = 0;
  for (int scene = 0; scene < 200; ++scene) {
    std::vector<vec3> corners(3);
    for (vec3& c : corners) c = vec3(random.in_cube(scene % 2 == 0 ? 2.0 : 20.0));
    const points::Receiver receiver = [&] {
      points::Receiver r;
      r.a = corners[0], r.e1 = dvec3(corners[1]) - r.a, r.e2 = dvec3(corners[2]) - r.a;
      r.normal = glm::cross(r.e1, r.e2);
      const double area2 = glm::dot(r.normal, r.normal);
      r.du = glm::cross(r.e2, r.normal) / area2, r.dv = glm::cross(r.normal, r.e1) / area2;
      return r;
    }();
    const auto whole = points_of(std::vector<std::uint32_t>(8 * 8, 0), 8, 8, pinhole, corners);
    for (int y = 0; y < 8; ++y) {
      const points::PixelRow row{pinhole.eye, pinhole.d0, pinhole.dx, (y + 0.5) * dvec3(pinhole.dy)};
      for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
        if (!simd_level_supported(level)) continue;
        dvec3 eight[8];
        const std::uint32_t inside = points::visible_run_kernels(level).eight(receiver, row, 0, eight);
        for (int x = 0; x < 8; ++x) {
          if (((inside >> x) & 1u) == 0) continue;
          ++met;
          EXPECT_EQ(eight[x], whole.positions[8 * y + x]) << scene;
        }
      }
      for (int x = 0; x < 8; ++x) {
        ViewRays moved = pinhole;  // pixel (x, y) first: exact, as all steps are powers of two
        moved.d0 += static_cast<float>(x) * pinhole.dx + static_cast<float>(y) * pinhole.dy;
        EXPECT_EQ(points_of({0}, 1, 1, moved, corners).positions[0], whole.positions[8 * y + x]) << scene;
      }
    }
  }
  EXPECT_GT(met, 500);
}

}  // namespace
}  // namespace tenebra
