// The distant face of directional and far lights: its bounds hold, on each instruction set.
#include <gtest/gtest.h>

#include <cmath>

#include "points/contact_rule.h"
#include "points/point_tiles.h"
#include "shadow/decision/decide.h"
#include "shadow/distant_lights.h"
#include "shadow/mask_case.h"
#include "shadow/tiles/descent.h"
#include "shadow/tiles/tile_kernels.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using glm::vec3;
using shadow::DistantFace;
using shadow::FaceBox;
using shadow::RaySource;

/// `offset` moves the scene, whose size is about 1.
ShadowLight light_towards(const dvec3& direction, double distance, const dvec3& offset) {
  if (distance > 0) return point_light(offset + distance * direction);
  ShadowLight light = sun(direction);
  light.to_light *= 3.0f;  // any length
  return light;
}

/// 0: at infinity.
const double distances[] = {0, 100, 1e3, 1e9, 1e18, 3e38};

/// Rays around a place, and a triangle aimed at them: what decides are the last bits of the bounds.
struct Arrangement {
  Soup soup;  ///< 0: the triangle; 1: what the points lie on
  std::vector<dvec3> points;
  ShadowLight light;
  DistantFace face;
  RaySource source;
};

points::PointTiles tiles_around(const dvec3& centre, double radius) {
  points::PointTiles tiles;
  points::PointSquare square{};
  const vec3 at(centre);
  square.base = {{at.x, at.y, at.z}, static_cast<float>(radius)};
  tiles.patches.resize(1);
  tiles.patches[0].squares.push_back(square);
  return tiles;
}

std::optional<Arrangement> arrangement(Random& random, double distance, double spread) {
  Arrangement a;
  const dvec3 offset = random.chance(0.5) ? dvec3(0) : 1e3 * random.in_cube(1);
  const dvec3 direction = direction_of_kind(static_cast<int>(random.index(3)), random);
  a.light = light_towards(direction, distance, offset);
  const auto face = shadow::distant_face(a.light, tiles_around(offset, 1.5));
  if (!face) return std::nullopt;
  a.face = *face;
  a.source = shadow::distant_source(shadow::ray_source(a.light), a.face);
  const dvec3 centre = offset + random.in_cube(0.7);
  for (int i = 0; i < 16; ++i) a.points.push_back(centre + spread * random.in_cube(1));
  // Beside the ray of one of them, nearly touching it, on either side; at any height.
  const dvec3 target = a.points[random.index(16)];
  const dvec3 across = glm::normalize(glm::cross(direction, random.direction())),
              along = glm::cross(direction, across);
  const dvec3 on_ray = target + random.in(-0.3, 0.8) * direction;
  const double off = random.chance(0.3) ? 0.0 : spread * random.in(-2, 2) * std::pow(10.0, random.in(-8, 0));
  const double size = std::max(spread, 1e-3) * std::pow(10.0, random.in(-1, 2));
  const dvec3 edge = on_ray + off * across;
  if (random.chance(0.2)) {  // in front of or behind them all, and large
    a.soup.add(edge + 30.0 * spread * across, edge - 30.0 * spread * (across + along),
               edge - 30.0 * spread * (across - along));
  } else {
    const double tilt = random.chance(0.3) ? 0.0 : random.in(-2, 2);
    a.soup.add(edge + size * along, edge - size * random.in(0.2, 1) * along,
               edge + size * (across + tilt * direction + random.in(-0.3, 0.3) * along));
  }
  a.soup.add(centre + across, centre - across, centre + along);
  return a;
}

FaceBox box_around(const Arrangement& a) {
  constexpr float inf = INFINITY;
  FaceBox box{inf, -inf, inf, -inf, inf, -inf};
  for (const dvec3& p : a.points) {
    const dvec3 at = a.face.place(p - dvec3(a.face.origin));
    const auto down = [](double x) { return std::nextafter(static_cast<float>(x), -INFINITY); };
    const auto up = [](double x) { return std::nextafter(static_cast<float>(x), INFINITY); };
    box.u0 = std::min(box.u0, down(at.x)), box.u1 = std::max(box.u1, up(at.x));
    box.v0 = std::min(box.v0, down(at.y)), box.v1 = std::max(box.v1, up(at.y));
    box.w = std::min(box.w, down(at.z)), box.w1 = std::max(box.w1, up(at.z));
  }
  return box;
}

struct Tally {
  int met = 0, missed = 0, covered = 0, blocked = 0;
};

void check_cluster(const Arrangement& a, const shadow::DescentKernels& kernels, ContactRule contact,
                   Tally& tally) {
  const vec3 v[3] = {a.soup.corner(0, 0), a.soup.corner(0, 1), a.soup.corner(0, 2)};
  shadow::TriangleCluster cluster{};
  shadow::BoxNode boxes{};
  for (int k = 0; k < 3; ++k) cluster.x[k][0] = v[k].x, cluster.y[k][0] = v[k].y, cluster.z[k][0] = v[k].z;
  cluster.used = 1;
  for (int axis = 0; axis < 3; ++axis) {
    boxes.low[axis][0] = std::min({v[0][axis], v[1][axis], v[2][axis]});
    boxes.high[axis][0] = std::max({v[0][axis], v[1][axis], v[2][axis]});
  }
  const int side = shadow::light_side(v, a.source);
  if (side == 0) return;
  const bool ids = contact == ContactRule::triangle_ids;
  const vec3 own[3] = {a.soup.corner(1, 0), a.soup.corner(1, 1), a.soup.corner(1, 2)};
  const auto tau = ids ? std::nextafter(static_cast<float>(points::rounding_tolerance(own)), 1e30f) : 0.0f;
  const shadow::TrianglePlanes planes =
      shadow::planes_of(v, 0, side, a.source, ids ? points::rounding_tolerance(v) : 0.0);
  const shadow::ClusterVerdict verdict =
      kernels.meet(cluster, boxes, a.source, 0, &a.face, box_around(a), tau);
  TraceStats stats;
  int blocked = 0;
  for (const dvec3& p : a.points)
    blocked += shadow::decide(planes, p, ids ? 1u : no_triangle, a.source, a.soup.view(), contact, stats);
  if ((verdict.met & 1u) == 0) {
    ASSERT_EQ(blocked, 0) << "rejected, but some ray is blocked";
  }
  if ((verdict.covered & 1u) != 0) {
    ASSERT_EQ(blocked, 16) << "covered, but some ray is free";
  }
  tally.met += static_cast<int>(verdict.met & 1u), tally.missed += static_cast<int>(~verdict.met & 1u);
  tally.covered += static_cast<int>(verdict.covered & 1u), tally.blocked += blocked > 0;
}

class DistantFaceBounds : public ::testing::TestWithParam<SimdLevel> {
protected:
  void SetUp() override {
    // Kernels of a vector level run only where the processor has it.
    if (!simd_level_supported(GetParam()))
      GTEST_SKIP() << "this machine or this build lacks " << simd_level_name(GetParam());
  }
};

TEST_P(DistantFaceBounds, NeverRejectABlockerNorAcceptAGap) {
  const shadow::DescentKernels kernels = shadow::descent_kernels(GetParam());
  for (const double distance : distances) {
    Tally tally;
    for (const double spread : {1e-6, 1e-4, 1e-2, 0.3}) {
      for (std::uint64_t seed = 0; seed < 2500; ++seed) {
        Random random(seed * 7 + 1);
        const auto a = arrangement(random, distance, spread);
        ASSERT_TRUE(a);
        check_cluster(*a, kernels, seed % 2 == 0 ? ContactRule::none : ContactRule::triangle_ids, tally);
        ASSERT_FALSE(HasFatalFailure())
            << "seed " << seed << ", spread " << spread << ", distance " << distance;
      }
    }
    // Not so cautious as to be of no use.
    EXPECT_GT(tally.blocked, 2000) << distance;
    EXPECT_GT(tally.missed, 1000) << distance;
    EXPECT_GT(tally.covered, 200) << distance;
  }
}

/// Boxes of tiles and of single tiles hold all their points; u, v and w in double, which is nothing beside
/// floats.
TEST_P(DistantFaceBounds, HoldAllPointsOfTheirTiles) {
  const shadow::TileKernels kernels = shadow::tile_kernels(GetParam());
  for (int turn = 0; turn < 60; ++turn) {
    Random random(static_cast<std::uint64_t>(turn));
    const double scale = std::pow(10.0, random.in(-12, 12));
    const dvec3 offset = random.chance(0.5) ? dvec3(0) : scale * 1e3 * random.in_cube(1);
    const Soup soup = room(random, 60).moved(scale, offset);
    const ViewRays view = pinhole(offset + scale * dvec3(-1.8, 1.5, -1.7), offset, 0.9, 96, 64);
    VisiblePoints points = view_samples(soup.view(), view, 96, 64);
    points::PointTiles tiles;
    points::make_point_tiles(seen_from(points, view), soup.view(), tiles);
    const dvec3 direction = direction_of_kind(turn % 3, random);
    const double distance = distances[static_cast<std::size_t>(turn) % std::size(distances)];
    const auto face =
        shadow::distant_face(light_towards(direction, std::min(distance * scale, 3e38), offset), tiles);
    ASSERT_TRUE(face) << turn;
    const points::TilePixels pixels(96, 64);
    for (const points::PointSquare& square : tiles.patches.front().squares) {
      shadow::RayNode node{};
      FaceBox all{}, own{};
      kernels.project_distant(square, square.filled, *face, node, all);
      for (std::uint32_t t = 0; t < 16; ++t) {
        if (((square.filled >> t) & 1u) == 0) continue;
        const points::PointTile& tile = tiles.tiles[square.first_tile + t];
        kernels.bound_distant(tile, square.base, square.lanes[t], *face, own);
        for (int lane = 0; lane < 16; ++lane) {
          if (((square.lanes[t] >> lane) & 1) == 0) continue;
          const dvec3 p = points.positions[pixels(square.first_tile + t, lane)] - dvec3(face->origin);
          const dvec3 at = face->place(p);
          for (const FaceBox& box : {node.box(static_cast<int>(t)), all, own}) {
            ASSERT_TRUE(box.u0 <= at.x && at.x <= box.u1) << turn << " u " << at.x;
            ASSERT_TRUE(box.v0 <= at.y && at.y <= box.v1) << turn << " v " << at.y;
            ASSERT_TRUE(box.w <= at.z && at.z <= box.w1) << turn << " w " << at.z;
          }
          ASSERT_LE(std::abs(at.x) + std::abs(at.y), static_cast<double>(face->across));
          ASSERT_LE(std::abs(at.z), static_cast<double>(face->along));
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryInstructionSet, DistantFaceBounds, ::testing::ValuesIn(simd_levels),
                         [](const auto& info) { return std::string(simd_level_name(info.param)); });

/// u and v stay as they are along a ray, and w grows: what the face rests on.
TEST(DistantFace, ARayIsOnePoint) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    const dvec3 direction = direction_of_kind(static_cast<int>(seed % 3), random);
    const double distance = distances[seed % 4];
    const auto face =
        shadow::distant_face(light_towards(direction, distance, dvec3(0)), tiles_around(dvec3(0), 1));
    ASSERT_TRUE(face);
    const dvec3 p = random.in_cube(1), origin(face->origin);
    const ShadowLight light = light_towards(direction, distance, dvec3(0));
    const dvec3 to_light = distance > 0 ? dvec3(light.position) - p : dvec3(light.to_light);
    const dvec3 a = face->place(p - origin),
                b = face->place(p + 0.2 / glm::length(to_light) * to_light - origin);
    EXPECT_NEAR(a.x, b.x, 1e-13) << seed;
    EXPECT_NEAR(a.y, b.y, 1e-13) << seed;
    EXPECT_GT(b.z, a.z) << seed;
  }
}

}  // namespace
}  // namespace tenebra::testing
