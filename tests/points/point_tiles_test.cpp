// Tiles say the same as the points in double that they are made of, or nothing.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

#include "parallel/parallel.h"
#include "points/contact_rule.h"
#include "points/point_tile_kernels.h"
#include "points/point_tiles.h"
#include "points/triangle_corners.h"
#include "support/samples.h"
#include "support/seeded_random.h"

namespace tenebra::testing {
namespace {

constexpr double u = 0x1p-24;

struct TiledCase {
  Soup soup;
  ViewRays view;
  VisiblePoints points;
};

TiledCase tiled_room(std::uint64_t seed, int width, int height, double scale = 1, double offset = 0) {
  Random random(seed);
  TiledCase c;
  c.soup = room(random, 400).moved(scale, glm::dvec3(offset));
  c.view = pinhole(glm::dvec3(-1.8, 1.5, -1.7) * scale + offset, glm::dvec3(offset), 0.9, width, height);
  const VisiblePoints seen = view_samples(c.soup.view(), c.view, width, height);
  compute_visible_points(seen.triangles, width, height, c.view, c.soup.view(), c.points,
                         PointLayout::rows_and_tiles);
  return c;
}

/// The parts of a tile of several receivers, from entry `at` on: they share its lanes out among them.
std::span<const points::ReceiverLanes> parts_of(const points::PointPatch& patch, std::size_t at,
                                                std::uint32_t lanes) {
  std::uint32_t found = 0;
  std::size_t count = 0;
  for (; found != lanes && at + count < patch.mixed.size(); ++count) {
    EXPECT_NE(patch.mixed[at + count].lanes, 0);
    EXPECT_EQ(patch.mixed[at + count].lanes & found, 0u);
    found |= patch.mixed[at + count].lanes;
  }
  EXPECT_EQ(found, lanes);
  return std::span(patch.mixed).subspan(at, count);
}

std::uint16_t receiver_at(std::span<const points::ReceiverLanes> parts, std::uint32_t lane) {
  for (const points::ReceiverLanes& part : parts)
    if (((part.lanes >> lane) & 1) != 0) return part.receiver;
  return points::several_receivers;
}

/// One tile of a square against the points of its pixels; `mixed`: what it lies on, if that is several.
void check_tile(const TiledCase& c, const points::PointPatch& patch, const points::PointSquare& square,
                std::uint32_t t, std::span<const points::ReceiverLanes> mixed) {
  const std::uint32_t number = square.first_tile + t;
  const points::PointTile& tile = c.points.tiles->tiles[number];
  const points::TilePixels pixel_of(c.points.width, c.points.height);
  EXPECT_EQ(std::memcmp(&c.points.tiles->bases[number / 16], &square.base, sizeof(points::PointBase)), 0);
  for (std::uint32_t lane = 0; lane < 16; ++lane) {
    if (((square.lanes[t] >> lane) & 1u) == 0) {
      if (!mixed.empty()) {
        EXPECT_EQ(tile.id[lane], no_triangle);
      }
      continue;
    }
    const std::size_t pixel = pixel_of(number, static_cast<int>(lane));
    const std::uint32_t id = c.points.triangles[pixel];
    const std::uint16_t receiver = mixed.empty() ? square.receiver[t] : receiver_at(mixed, lane);
    ASSERT_LT(receiver, patch.receiver_count);
    EXPECT_EQ(patch.receivers[receiver / 16].id[receiver % 16], id);
    if (!mixed.empty()) {
      EXPECT_EQ(tile.id[lane], id);
    }
    EXPECT_EQ(square.own[t], mixed.empty() ? id : no_triangle);
    EXPECT_GE(square.tau, points::rounding_tolerance(points::corners_of(c.soup.view(), id).v));
    const float q[3] = {tile.qx[lane], tile.qy[lane], tile.qz[lane]};
    double length2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double exact = c.points.positions[pixel][axis] - static_cast<double>(square.base.at[axis]);
      EXPECT_LE(std::abs(static_cast<double>(q[axis]) - exact), u * std::abs(exact) + 1e-40);
      EXPECT_LE(square.low[axis][t], q[axis]);
      EXPECT_GE(square.high[axis][t], q[axis]);
      length2 += static_cast<double>(q[axis]) * static_cast<double>(q[axis]);
    }
    EXPECT_GE(static_cast<double>(square.base.radius), std::sqrt(length2));
  }
}

/// All tiles of a case; returns how many lie on several triangles.
std::size_t check_tiles(const TiledCase& c) {
  std::size_t several_tiles = 0;
  for (const points::PointPatch& patch : c.points.tiles->patches) {
    std::size_t mixed = 0;
    for (const points::PointSquare& square : patch.squares) {
      for (std::uint32_t t = 0; t < 16; ++t) {
        if (((square.filled >> t) & 1u) == 0) continue;
        const bool several = square.receiver[t] == points::several_receivers;
        const auto parts =
            several ? parts_of(patch, mixed, square.lanes[t]) : std::span<const points::ReceiverLanes>();
        check_tile(c, patch, square, t, parts);
        mixed += parts.size();
        several_tiles += several ? 1 : 0;
      }
    }
    EXPECT_EQ(mixed, patch.mixed.size());
  }
  return several_tiles;
}

TEST(PointTiles, HoldThePointsThatFaceTheEye) {
  for (const auto& [width, height] : {std::pair{97, 61}, {16, 16}, {5, 3}, {1040, 18}}) {
    const TiledCase c = tiled_room(31, width, height);
    const points::TilePixels pixel_of(width, height);
    std::vector<int> met(c.points.triangles.size(), 0);
    EXPECT_GT(check_tiles(c), 0u);
    for (const points::PointPatch& patch : c.points.tiles->patches) {
      for (const points::PointSquare& square : patch.squares) {
        for (std::uint32_t t = 0; t < 16; ++t) {
          if (((square.filled >> t) & 1u) == 0) continue;
          for (std::uint32_t lanes = square.lanes[t]; lanes != 0; lanes &= lanes - 1)
            ++met[pixel_of(square.first_tile + t, std::countr_zero(lanes))];
        }
      }
    }
    for (std::size_t i = 0; i < met.size(); ++i) {
      const std::uint32_t id = c.points.triangles[i];
      const bool seen =
          id != no_triangle && points::eye_side(points::corners_of(c.soup.view(), id).v, c.view) != 0;
      EXPECT_EQ(met[i], seen ? 1 : 0) << i;
    }
  }
}

TEST(PointTiles, TakeTheIdsOfTrianglesThatAreThere) {
  Random random(33);
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{0x80000000},
                                  std::size_t{0xffffffff}, std::size_t{1} << 40}) {
    std::vector<std::uint32_t> ids(16 * 40 + 7), taken(ids.size());
    const auto end = static_cast<std::uint32_t>(count);
    for (std::uint32_t& id : ids) {
      const std::uint32_t near[] = {0,          1,          end - 1,    end,        end + 1,
                                    0x7fffffff, 0x80000000, 0xfffffffe, no_triangle};
      id = near[random.index(std::size(near))];
    }
    for (const SimdLevel level :
         {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::automatic}) {
      if (!simd_level_supported(level)) continue;
      points::point_tile_kernels(level).copy_ids(ids, count, taken.data());
      for (std::size_t i = 0; i < ids.size(); ++i)
        ASSERT_EQ(taken[i], ids[i] < count ? ids[i] : no_triangle) << count << ", " << i;
    }
  }
}

TEST(PointTiles, StayPreciseFarFromTheOrigin) {
  const TiledCase c = tiled_room(32, 64, 64, 1, 1e6);
  EXPECT_GT(check_tiles(c), 0u);
  for (const points::PointPatch& patch : c.points.tiles->patches)
    for (const points::PointSquare& square : patch.squares) EXPECT_LT(square.base.radius, 100);
}

// What a receiver says of a light, beyond its slack, is what the exact sign says.
TEST(PointTiles, ReceiversKnowTheirSide) {
  const TiledCase c = tiled_room(33, 64, 64);
  Random random(34);
  int certain = 0;
  for (const points::PointPatch& patch : c.points.tiles->patches) {
    for (std::uint32_t number = 0; number < patch.receiver_count; ++number) {
      const points::ReceiverBlock& b = patch.receivers[number / 16];
      const std::uint32_t i = number % 16;
      const points::Corners corners = points::corners_of(c.soup.view(), b.id[i]);
      for (int k = 0; k < 20; ++k) {
        const glm::dvec3 near = glm::mix(glm::dvec3(corners.v[0]), glm::dvec3(corners.v[1]), 0.3);
        const glm::vec3 p(near + random.in_cube(k % 2 == 0 ? 2.0 : 1e-6));
        const glm::dvec3 away = glm::dvec3(p) - glm::dvec3(corners.v[0]);
        const double value = glm::dot(glm::dvec3(b.nx[i], b.ny[i], b.nz[i]), away);
        if (std::abs(value) <= static_cast<double>(b.slack[i]) * glm::length(away)) continue;
        ++certain;
        const int side = math::point_side(corners.v[0], corners.v[1], corners.v[2], p) * b.side[i];
        EXPECT_EQ(side, value > 0 ? 1 : -1);
      }
    }
  }
  EXPECT_GT(certain, 1000);
}

bool same_tiles(const points::PointTiles& a, const points::PointTiles& b) {
  const auto same = [](const auto& x, const auto& y, std::size_t bytes) {
    bool equal = x.size() == y.size();
    for (std::size_t i = 0; equal && i < x.size(); ++i) equal = std::memcmp(&x[i], &y[i], bytes) == 0;
    return equal;
  };
  bool equal = same(a.tiles, b.tiles, sizeof(points::PointTile)) && a.patches.size() == b.patches.size();
  for (std::size_t i = 0; equal && i < a.patches.size(); ++i) {
    const points::PointPatch &pa = a.patches[i], &pb = b.patches[i];
    equal = pa.receiver_count == pb.receiver_count && pa.mixed == pb.mixed &&
            same(pa.squares, pb.squares, offsetof(points::PointSquare, tau) + sizeof(float));
  }
  return equal;
}

/// What is said of tiles made from a view: q as close to the positions `at` as the grain says, all else as in
/// tiles made from positions. Returns how many squares are less close than rounded ones.
std::size_t check_seen_tiles(const points::PointTiles& seen, const points::PointTiles& rounded,
                             const VisiblePoints& at) {
  const points::TilePixels pixel_of(at.width, at.height);
  std::size_t coarse = 0;
  EXPECT_EQ(seen.patches.size(), rounded.patches.size());
  for (std::size_t i = 0; i < seen.patches.size(); ++i) {
    const points::PointPatch &a = seen.patches[i], &b = rounded.patches[i];
    EXPECT_EQ(a.receiver_count, b.receiver_count);
    EXPECT_EQ(a.mixed, b.mixed);
    EXPECT_EQ(a.squares.size(), b.squares.size());
    for (std::size_t s = 0; s < a.squares.size(); ++s) {
      const points::PointSquare &one = a.squares[s], &two = b.squares[s];
      EXPECT_EQ(one.filled, two.filled);
      EXPECT_EQ(one.gaps, two.gaps);
      EXPECT_EQ(one.tau, two.tau);
      EXPECT_EQ(std::memcmp(one.base.at, two.base.at, sizeof one.base.at), 0);
      EXPECT_GE(one.base.grain, one.base.radius);
      coarse += one.base.grain > one.base.radius ? 1 : 0;
      for (std::uint32_t left = one.filled; left != 0; left &= left - 1) {
        const int t = std::countr_zero(left);
        EXPECT_EQ(one.own[t], two.own[t]);
        EXPECT_EQ(one.receiver[t], two.receiver[t]);
        EXPECT_EQ(one.lanes[t], two.lanes[t]);
        const std::uint32_t number = one.first_tile + static_cast<std::uint32_t>(t);
        const points::PointTile& tile = seen.tiles[number];
        for (std::uint32_t lanes = one.lanes[t]; lanes != 0; lanes &= lanes - 1) {
          const int lane = std::countr_zero(lanes);
          const glm::dvec3 q(tile.qx[lane], tile.qy[lane], tile.qz[lane]);
          const glm::dvec3 exact = at.positions[pixel_of(number, lane)] -
                                   glm::dvec3(one.base.at[0], one.base.at[1], one.base.at[2]);
          EXPECT_LE(glm::length(q - exact), u * static_cast<double>(one.base.grain) + 1e-40);
          EXPECT_LE(glm::length(q), static_cast<double>(one.base.radius));
        }
      }
    }
  }
  return coarse;
}

TEST(PointTiles, AreTheSameForAllThreads) {
  const TiledCase c = tiled_room(35, 130, 70);
  points::PointTiles again;
  with_threads(7, [&] { points::make_point_tiles(seen_from(c.points, c.view), c.soup.view(), again); });
  EXPECT_TRUE(same_tiles(again, *c.points.tiles));
}

// From ids and a view, without positions in between: the same points, also where a rasteriser's id is that of
// a triangle which the ray just misses, or which has no area; from the eye of a perspective view partly in
// float.
TEST(PointTiles, AreTheSameWithoutPositions) {
  std::size_t coarse = 0;
  for (int scene = 0; scene < 24; ++scene) {
    const double scale = scene % 4 == 1 ? 1e-12 : scene % 4 == 2 ? 1e9 : 1;
    const int width = scene % 5 == 0 ? 1040 : 61 + scene, height = 37 - scene;
    TiledCase c =
        tiled_room(50 + static_cast<std::uint64_t>(scene), width, height, scale, scene % 4 == 3 ? 1e5 : 0);
    Random random(80 + static_cast<std::uint64_t>(scene));
    std::vector<std::uint32_t> ids = c.points.triangles;
    for (std::uint32_t& id : ids) {
      const auto count = static_cast<std::uint32_t>(c.soup.triangles.size());
      if (scene % 3 != 0 && random.chance(0.1)) id = random.index(count + 2);  // some of none
    }
    for (std::size_t t = 0; t < c.soup.triangles.size(); t += 7)
      c.soup.triangles[t].z = c.soup.triangles[t].y;
    c.view.orthographic = scene % 2 == 1;
    VisiblePoints whole, bare;  // tiles without points keep what was there before: both begin with nothing
    compute_visible_points(ids, width, height, c.view, c.soup.view(), whole, PointLayout::rows_and_tiles);
    compute_visible_points(ids, width, height, c.view, c.soup.view(), bare, PointLayout::tiles);
    EXPECT_EQ(bare.triangles, whole.triangles);
    coarse += check_seen_tiles(*bare.tiles, *whole.tiles, whole);
    if (c.view.orthographic) {
      EXPECT_TRUE(same_tiles(*bare.tiles, *whole.tiles)) << scene;
    }
  }
  EXPECT_GT(coarse, 100u);
}

TEST(PointTiles, SeeTheSameWithAllInstructionSets) {
  Random random(90);
  for (int scene = 0; scene < 400; ++scene) {
    ViewRays view = pinhole(random.in_cube(3), random.in_cube(1), 0.9, 40, 40);
    view.orthographic = scene % 2 == 1;
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 48; ++i) corners.emplace_back(random.in_cube(scene % 3 == 0 ? 20.0 : 2.0));
    std::vector<points::Receiver> receivers;
    std::vector<points::ReceiverLanes> parts;
    std::size_t of[16];
    const std::vector<glm::uvec3> triangles = [] {
      std::vector<glm::uvec3> t;
      for (std::uint32_t i = 0; i < 16; ++i) t.emplace_back(3 * i, 3 * i + 1, i == 5 ? 3 * i + 1 : 3 * i + 2);
      return t;
    }();
    for (std::uint32_t i = 0; i < 16; ++i)
      receivers.push_back(points::receiver_of({.positions = corners, .triangles = triangles}, i));
    const std::uint32_t different = scene % 5 == 0 ? 1 : scene % 5 == 1 ? 3 : 16;
    for (std::uint32_t i = 0; i < different; ++i) parts.push_back({static_cast<std::uint16_t>(i), 0});
    for (std::uint32_t i = 0; i < 16; ++i) {
      of[i] = different == 3 ? random.index(3) : i % different;
      parts[of[i]].lanes = static_cast<std::uint16_t>(parts[of[i]].lanes | 1u << i);
    }
    const points::PixelRays rays(view);
    const glm::uvec2 at(4 * random.index(10), 4 * random.index(10));
    for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      const points::PointTileKernels kernels = points::point_tile_kernels(level);
      points::TilePoints found;
      const std::uint32_t inside = kernels.see(receivers.data(), parts, rays, at, found);
      for (int lane = 0; lane < 16; ++lane) {
        const glm::dvec3 expected = rays.point_on(receivers[of[lane]], at.x + lane % 4, at.y + lane / 4);
        if (((inside >> lane) & 1u) != 0) {
          EXPECT_EQ(found.at(lane), expected) << scene << " " << lane;
        }
      }
    }
  }
}

}  // namespace
}  // namespace tenebra::testing
