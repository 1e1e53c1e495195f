// Points lifted to the surface that vertex normals describe.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "points/point_tiles.h"
#include "points/smooth_surface.h"
#include "points/triangle_corners.h"
#include "support/round_bodies.h"
#include "support/samples.h"
#include "support/seeded_random.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using glm::vec3;

const ViewRays from_outside = pinhole({0.3, 1.1, 6}, {0, 0, 0}, 0.2, 160, 120);

points::SmoothSurface surface_of(const RoundBody& body, std::uint32_t id, const ViewRays& view) {
  return points::smooth_surface(body.smooth(), id,
                                points::eye_side(points::corners_of(body.flat(), id).v, view));
}

VisiblePoints seen(const RoundBody& body, const TriangleView& triangles, const ViewRays& view, int width,
                   int height, PointLayout layout) {
  const VisiblePoints ids = view_samples(body.flat(), view, width, height);
  VisiblePoints points;
  compute_visible_points(ids.triangles, width, height, view, triangles, points, layout);
  return points;
}

// On a sphere the lifted point is not inside of it, and no farther off than the triangles lie below it.
TEST(SmoothSurface, LiftsToASphereOrBeyondByNoMoreThanItsSagitta) {
  const RoundBody body = round_body(10, 16);
  const VisiblePoints below = seen(body, body.flat(), from_outside, 160, 120, PointLayout::rows),
                      on = seen(body, body.smooth(), from_outside, 160, 120, PointLayout::rows);
  std::size_t count = 0;
  double lowest = 2;
  for (std::size_t i = 0; i < on.triangles.size(); ++i) {
    if (on.triangles[i] == no_triangle) continue;
    const double before = glm::length(below.positions[i]), after = glm::length(on.positions[i]);
    EXPECT_GE(after, 1 - 1e-6) << i;
    EXPECT_LE(after - 1, 1 - before + 0.002) << i;
    lowest = std::min(lowest, before);
    ++count;
  }
  EXPECT_GT(count, 3000u);
  EXPECT_LT(lowest, 0.97);
}

TEST(SmoothSurface, NeighboursLiftTheirEdgeAlike) {
  const RoundBody body = round_body(9, 14, {0.2, 0.1, -0.3}, 0.12);
  int edges = 0, lifted_edges = 0;
  for (std::uint32_t one = 0; one < body.triangles.size(); ++one) {
    for (std::uint32_t other = one + 1; other < body.triangles.size(); ++other) {
      std::vector<std::uint32_t> shared;
      for (int k = 0; k < 3; ++k)
        for (int m = 0; m < 3; ++m)
          if (body.triangles[one][k] == body.triangles[other][m]) shared.push_back(body.triangles[one][k]);
      if (shared.size() != 2) continue;
      const auto a = surface_of(body, one, from_outside), b = surface_of(body, other, from_outside);
      const auto side = [&](std::uint32_t id) {
        return points::eye_side(points::corners_of(body.flat(), id).v, from_outside);
      };
      if (!a.lifts || !b.lifts || side(one) != side(other)) continue;
      ++edges;
      for (const double t : {0.0, 0.1, 0.5, 0.77, 1.0}) {
        const dvec3 p = (1 - t) * dvec3(body.positions[shared[0]]) + t * dvec3(body.positions[shared[1]]);
        const dvec3 from_a = points::lifted(a, p), from_b = points::lifted(b, p);
        EXPECT_LT(glm::length(from_a - from_b), 1e-13) << one << ' ' << other << ' ' << t;
        if (t == 0 || t == 1) {
          EXPECT_LT(glm::length(from_a - p), 1e-13);
        }
        lifted_edges += t == 0.5 && glm::length(from_a - p) > 1e-3;
      }
    }
  }
  EXPECT_GT(edges, 150);
  EXPECT_GT(lifted_edges, 100);
}

TEST(SmoothSurface, WhatIsHollowFlatOrContradictedStays) {
  RoundBody body = round_body(10, 16);
  const ViewRays from_inside = pinhole({0, 0, 0}, {0.1, 0, 1}, 1.5, 8, 8);
  int lifts = 0, hollow = 0;
  for (std::uint32_t id = 0; id < body.triangles.size(); ++id) {
    lifts += surface_of(body, id, from_outside).lifts;
    hollow += surface_of(body, id, from_inside).lifts;
  }
  // Those that the eye sees the backs of are hollow from there.
  EXPECT_GT(lifts, static_cast<int>(body.triangles.size()) / 3);
  EXPECT_EQ(hollow, 0);
  std::uint32_t id = 0;
  while (!surface_of(body, id, from_outside).lifts) ++id;
  const std::vector<vec3> normals = body.normals;
  const glm::uvec3 t = body.triangles[id];
  body.normals[t.x] = body.normals[t.y] = body.normals[t.z] = vec3(0, 0, 1);
  EXPECT_FALSE(surface_of(body, id, from_outside).lifts) << "equal";
  body.normals[t.x] = body.normals[t.y] = body.normals[t.z] = vec3(0);
  EXPECT_FALSE(surface_of(body, id, from_outside).lifts) << "none";
  body.normals = normals;
  body.normals[t.x] = -body.normals[t.x];
  EXPECT_FALSE(surface_of(body, id, from_outside).lifts) << "on both sides";
  body.normals = normals;
  body.positions[t.y] = body.positions[t.x];
  EXPECT_FALSE(surface_of(body, id, from_outside).lifts) << "no area";
}

// A plane whose vertices and normals are off by their rounding, anywhere.
TEST(SmoothSurface, RoundingIsNoCurve) {
  Random random(7);
  for (int i = 0; i < 3000; ++i) {
    const dvec3 n = random.direction();
    const dvec3 x = glm::normalize(glm::cross(n, dvec3(0.3, 0.5, 0.8))), y = glm::cross(n, x);
    const double scale = std::pow(10.0, random.in(-3, 3));
    const dvec3 centre = scale * random.in(0, 100) * dvec3(1, -1, 0.5);
    RoundBody body;
    for (int k = 0; k < 3; ++k) {
      body.positions.emplace_back(centre + scale * (random.in(-1, 1) * x + random.in(-1, 1) * y));
      body.normals.emplace_back(n);
      body.normals.back() = vec3(glm::normalize(dvec3(body.normals.back()) + 0x1p-26 * dvec3(k, -k, 2 * k)));
    }
    body.triangles = {{0, 1, 2}};
    body.casts = {1};
    ViewRays view = from_outside;
    view.eye = vec3(centre + 10 * scale * n);
    EXPECT_FALSE(surface_of(body, 0, view).lifts) << i;
  }
}

/// The points of tile t as close to their positions as the square's grain says.
void expect_close(const points::PointTile& tile, const points::PointSquare& square, std::uint32_t t,
                  const VisiblePoints& rows) {
  const points::TilePixels pixel_of(rows.width, rows.height);
  const dvec3 base(square.base.at[0], square.base.at[1], square.base.at[2]);
  for (std::uint32_t lane = 0; lane < 16; ++lane) {
    if (((square.lanes[t] >> lane) & 1u) == 0) continue;
    const dvec3 q(tile.qx[lane], tile.qy[lane], tile.qz[lane]);
    const dvec3 p = rows.positions[pixel_of(square.first_tile + t, static_cast<int>(lane))];
    EXPECT_LE(glm::length(q - (p - base)), 0x1p-24 * static_cast<double>(square.base.grain));
  }
}

// Rows, tiles, both, and points lifted afterwards are one and the same; tiles from a perspective view have
// them in float.
TEST(SmoothSurface, AllLayoutsHaveTheSamePoints) {
  const RoundBody body = round_body(10, 16, {0, 0, 0}, 0.1);
  const int width = 163, height = 117;
  for (const bool orthographic : {false, true}) {
    ViewRays view = pinhole({0.3, 1.1, 6}, {0, 0, 0}, 0.2, width, height);
    if (orthographic) {
      view.eye = {-1.5f, 1.3f, 5};
      view.d0 = {0, 0, -1}, view.dx = {0.018f, 0, 0}, view.dy = {0, -0.022f, 0};
      view.orthographic = true;
    }
    const VisiblePoints rows = seen(body, body.smooth(), view, width, height, PointLayout::rows),
                        both = seen(body, body.smooth(), view, width, height, PointLayout::rows_and_tiles),
                        tiles = seen(body, body.smooth(), view, width, height, PointLayout::tiles);
    VisiblePoints later = seen(body, body.flat(), view, width, height, PointLayout::rows_and_tiles);
    const VisiblePoints before = later;
    lift_visible_points(body.smooth(), later);
    std::size_t moved = 0, points = 0;
    for (std::size_t i = 0; i < rows.triangles.size(); ++i) {
      if (rows.triangles[i] == no_triangle) continue;
      ++points;
      moved += rows.positions[i] != before.positions[i];
      EXPECT_EQ(rows.positions[i], both.positions[i]);
      EXPECT_EQ(rows.positions[i], later.positions[i]);
      EXPECT_EQ(rows.positions[i], visible_position(tiles, body.smooth(), i));
    }
    EXPECT_GT(points, 2000u);
    EXPECT_GT(moved, points / 2);
    for (const VisiblePoints* other : std::initializer_list<const VisiblePoints*>{&tiles, &later}) {
      const auto &a = *both.tiles, &b = *other->tiles;
      ASSERT_EQ(a.patches.size(), b.patches.size());
      for (std::size_t p = 0; p < a.patches.size(); ++p) {
        ASSERT_EQ(a.patches[p].squares.size(), b.patches[p].squares.size());
        for (std::size_t s = 0; s < a.patches[p].squares.size(); ++s) {
          const points::PointSquare &one = a.patches[p].squares[s], &two = b.patches[p].squares[s];
          const bool in_float = other == &tiles && !orthographic;
          if (!in_float) {
            EXPECT_EQ(one.base.radius, two.base.radius);
          }
          EXPECT_EQ(one.filled, two.filled);
          for (std::uint32_t t = 0; t < 16; ++t) {
            if (((one.filled >> t) & 1u) == 0) continue;
            if (in_float) {
              expect_close(b.tiles[two.first_tile + t], two, t, rows);
              continue;
            }
            for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(one.low[axis][t], two.low[axis][t]);
            EXPECT_EQ(std::memcmp(a.tiles[one.first_tile + t].qx, b.tiles[two.first_tile + t].qx, 192), 0);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace tenebra::testing
