// Tiles of one triangle made in float: as close to the points in double as they claim, or not made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "points/point_tile_kernels.h"
#include "points/triangle_corners.h"
#include "support/samples.h"
#include "support/seeded_random.h"

namespace tenebra::testing {
namespace {

constexpr int picture_side = 64;  // pixels
constexpr double half_ulp = 0x1p-24;

struct PlaneCase {
  ViewRays view;
  glm::uvec2 at;
  std::vector<glm::vec3> corners;  ///< of triangles behind (or nearly) all pixels of the tile
};

/// Kinds: as in a room; with depths that differ (grazing); a narrow view; far from the origin; scales at
/// either end of the range of floats.
PlaneCase plane_case(Random& random, int kind, int triangles) {
  const double scale = kind == 4   ? std::abs(random.power_of_two(-125, -100))
                       : kind == 5 ? std::abs(random.power_of_two(60, 98))
                                   : 1;
  const glm::dvec3 middle = kind == 3 ? 1e6 * random.direction() : glm::dvec3(0);
  const double fov = kind == 2 ? std::abs(random.power_of_two(-22, -4)) : 0.9;
  PlaneCase c;
  c.view = pinhole(scale * (middle + random.in_cube(2)), scale * (middle + random.in_cube(2)), fov,
                   picture_side, picture_side);
  c.at = {4 * random.index(picture_side / 4), 4 * random.index(picture_side / 4)};
  const double depth = scale * std::abs(random.power_of_two(-4, 5));
  for (int k = 0; k < triangles; ++k) {
    const double uneven = kind == 1 ? 6 : random.in(0, 1), turn = random.in(0, 6.28),
                 away = random.in(3.5, random.chance(0.5) ? 12 : 400);
    for (int i = 0; i < 3; ++i) {
      const double angle = turn + 2.0943951 * i;
      const double x = c.at.x + 2 + away * std::cos(angle), y = c.at.y + 2 + away * std::sin(angle);
      const glm::dvec3 d = glm::dvec3(c.view.d0) + x * glm::dvec3(c.view.dx) + y * glm::dvec3(c.view.dy);
      c.corners.emplace_back(glm::dvec3(c.view.eye) + depth * std::exp2(random.in(-uneven, uneven)) * d);
    }
  }
  return c;
}

struct PlaneShare {
  int made = 0;
  double worst = 0;  ///< error as a share of what is claimed
};

/// Pixels of the tile, a part for each triangle; several parts share some of the lanes out among them.
std::vector<points::ReceiverLanes> parts_of(Random& random, std::uint16_t triangles) {
  if (triangles == 1) return {{0, 0xffff}};
  std::vector<points::ReceiverLanes> parts;
  for (std::uint16_t k = 0; k < triangles; ++k) parts.push_back({k, static_cast<std::uint16_t>(1u << k)});
  for (std::uint32_t lane = triangles; lane < 16; ++lane) {
    const std::uint32_t k = random.index(triangles + 1);
    if (k < triangles) parts[k].lanes = static_cast<std::uint16_t>(parts[k].lanes | 1u << lane);
  }
  return parts;
}

/// Looks at all points of the tile, if it was made.
void check(const PlaneCase& c, Random& random, const points::PointTileKernels& kernels, PlaneShare& share) {
  const auto count = static_cast<std::uint16_t>(c.corners.size() / 3);
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t k = 0; k < count; ++k) triangles.emplace_back(3 * k, 3 * k + 1, 3 * k + 2);
  const points::PixelRays rays(c.view);
  const points::RayRows rows(c.view, picture_side, picture_side);
  std::vector<points::Receiver> receivers;
  std::vector<points::SeenPlane> planes;
  for (std::uint32_t k = 0; k < count; ++k) {
    receivers.push_back(points::receiver_of({.positions = c.corners, .triangles = triangles}, k));
    planes.push_back(receivers[k].flat ? points::SeenPlane{} : points::seen_plane(receivers[k], rays, rows));
  }
  std::vector<const points::SeenPlane*> pointers;
  for (const points::SeenPlane& plane : planes) pointers.push_back(&plane);
  const std::vector<points::ReceiverLanes> parts = parts_of(random, count);
  // The base is the point of some pixel nearby.
  const glm::vec3 base(rays.point_on(receivers[0], c.at.x / 16 * 16 + 5, c.at.y / 16 * 16 + 9));
  const points::SquareEye eye = points::square_eye(rays.eye, base);
  points::PointTile tile;
  points::PointSquare square{};
  points::PlaneError error;
  const int place = 3;
  if (!(count == 1
            ? kernels.see_plane(planes[0], rows, eye, c.at, tile, place, square, error)
            : kernels.see_planes(pointers.data(), parts, rows, eye, c.at, tile, place, square, error))) {
    EXPECT_TRUE(error.none());
    return;
  }
  ++share.made;
  double radius = 0;
  for (int lane = 0; lane < points::tile_points; ++lane) {
    const glm::vec3 q(tile.qx[lane], tile.qy[lane], tile.qz[lane]);
    radius = std::max(radius, glm::length(glm::dvec3(q)));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(square.low[axis][place], q[axis]);
      EXPECT_GE(square.high[axis][place], q[axis]);
    }
  }
  const double grain = points::grain_of(static_cast<float>(radius), error);
  for (const points::ReceiverLanes& part : parts) {
    for (std::uint32_t lane = 0; lane < 16; ++lane) {
      if (((part.lanes >> lane) & 1u) == 0) continue;
      const glm::dvec3 p = rays.point_on(receivers[part.receiver], c.at.x + lane % 4, c.at.y + lane / 4);
      const glm::dvec3 q(tile.qx[lane], tile.qy[lane], tile.qz[lane]);
      const double off = glm::length(q - (p - glm::dvec3(base)));
      EXPECT_LE(off, half_ulp * grain);
      share.worst = std::max(share.worst, off / (half_ulp * grain));
    }
  }
}

TEST(SeenPlane, QIsAsCloseAsTheGrainSays) {
  for (const int triangles : {1, 3}) {
    for (int kind = 0; kind < 6; ++kind) {
      for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
        if (!simd_level_supported(level)) continue;
        const points::PointTileKernels kernels = points::point_tile_kernels(level);
        Random random(700 + static_cast<std::uint64_t>(kind));
        PlaneShare share;
        for (int i = 0; i < 3000; ++i) check(plane_case(random, kind, triangles), random, kernels, share);
        EXPECT_GT(share.made, kind == 1 ? 20 : 500) << kind << " " << triangles;
        EXPECT_GT(share.worst, kind == 3 ? 1e-3 : 0.05) << kind << ": a bound that says too little";
      }
    }
  }
}

// Tiles are left to doubles where a pixel's ray misses the triangle, however closely.
TEST(SeenPlane, NoPointLiesBesideItsTriangle) {
  const points::PointTileKernels kernels = points::point_tile_kernels(SimdLevel::automatic);
  Random random(710);
  int made = 0, left = 0;
  for (int i = 0; i < 20000; ++i) {
    PlaneCase c = plane_case(random, 0, 1);
    const std::vector<glm::uvec3> triangles{{0, 1, 2}};
    // An edge is moved to a pixel in a corner of the tile, and past it or not by a few roundings.
    const points::PixelRays rays(c.view);
    const glm::dvec3 d = rays.d0 + (c.at.x + 0.5) * rays.dx + (c.at.y + 0.5) * rays.dy;
    const glm::dvec3 on_edge = rays.eye + random.in(1, 3) * d, along = random.direction();
    const double nudge = random.chance(0.3) ? 0 : random.power_of_two(-50, -18);
    const glm::dvec3 inwards = (2.0 * rays.dx + 2.0 * rays.dy) * random.in(1, 3);
    c.corners = {glm::vec3(on_edge + 0.5 * along + nudge * inwards),
                 glm::vec3(on_edge - 0.5 * along + nudge * inwards),
                 glm::vec3(on_edge + 40.0 * inwards + 0.1 * random.direction())};
    const points::Receiver r = points::receiver_of({.positions = c.corners, .triangles = triangles}, 0);
    const points::RayRows rows(c.view, picture_side, picture_side);
    points::PointTile tile;
    points::PointSquare square{};
    points::PlaneError error;
    const points::SeenPlane plane = points::seen_plane(r, rays, rows);
    const points::SquareEye eye = points::square_eye(rays.eye, c.corners[0]);
    const points::SeenPlane* const pointer = &plane;
    const std::vector<points::ReceiverLanes> parts{{0, 0xffff}};
    if (!(i % 2 == 0 ? kernels.see_plane(plane, rows, eye, c.at, tile, 0, square, error)
                     : kernels.see_planes(&pointer, parts, rows, eye, c.at, tile, 0, square, error))) {
      ++left;
      continue;
    }
    ++made;
    for (std::uint32_t lane = 0; lane < 16; ++lane) {
      const glm::dvec3 to =
          rays.d0 + (c.at.x + lane % 4 + 0.5) * rays.dx + (c.at.y + lane / 4 + 0.5) * rays.dy;
      const double t = glm::dot(r.normal, r.a - rays.eye) / glm::dot(r.normal, to);
      const glm::dvec3 from = rays.eye + t * to - r.a;
      const double v1 = glm::dot(r.du, from), v2 = glm::dot(r.dv, from);
      EXPECT_TRUE(v1 >= 0 && v2 >= 0 && v1 + v2 <= 1 && t > 0) << v1 << " " << v2;
    }
  }
  EXPECT_GT(made, 1000);
  EXPECT_GT(left, 1000);
}

}  // namespace
}  // namespace tenebra::testing
