// Directional lights and lights at any distance: the bounds of the distant face, the mask, and what it takes.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "points/contact_rule.h"
#include "points/point_tiles.h"
#include "shadow/decision/decide.h"
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

constexpr SimdLevel levels[] = {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512};

/// `offset` moves the scene, whose size is about 1.
ShadowLight light_towards(const dvec3& direction, double distance, const dvec3& offset) {
  if (distance > 0) return point_light(offset + distance * direction);
  ShadowLight light = sun(direction);
  light.to_light *= 3.0f;  // any length
  return light;
}

/// 0: at infinity.
const double distances[] = {0, 100, 1e3, 1e9, 1e18, 3e38};

dvec3 direction_of_kind(int kind, Random& random) {
  if (kind == 0) return random.direction();
  dvec3 axis(0);
  axis[static_cast<int>(random.index(3))] = random.chance(0.5) ? 1 : -1;
  if (kind == 1) return axis;
  return glm::normalize(axis + std::pow(10.0, random.in(-9, -2)) * random.in_cube(1));
}

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
    if (!simd_level_supported(GetParam()))
      GTEST_SKIP() << "this machine lacks " << simd_level_name(GetParam());
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
    points::make_point_tiles(points, view, soup.view(), tiles);
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

INSTANTIATE_TEST_SUITE_P(EveryInstructionSet, DistantFaceBounds, ::testing::ValuesIn(levels),
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

/// Soups under directional light: along axes, nearly so, in the planes of triangles, along edges.
ShadowLight sun_of_kind(int kind, const Soup& soup, Random& random) {
  const auto id = random.index(static_cast<std::uint32_t>(soup.triangles.size()));
  const dvec3 a(soup.corner(id, 0)), b(soup.corner(id, 1)), c(soup.corner(id, 2));
  dvec3 to_light = direction_of_kind(kind, random);
  if (kind == 3) to_light = (b - a) + random.in(-1, 1) * (c - a);  // edge-on, but for rounding
  if (kind == 4) to_light = b - a;
  if (to_light == dvec3(0)) to_light = {0, 1, 0};
  const double largest = std::max({std::abs(to_light.x), std::abs(to_light.y), std::abs(to_light.z)});
  return sun(to_light / largest * std::pow(10.0, random.in(-30, 30)));
}

TEST(ShadowMaskSun, IsExactOnEverySoup) {
  Shares shares;
  std::uint64_t seed = 7000;
  for (const SoupMaker& maker : soup_makers())
    for (int kind = 0; kind < 5; ++kind) {
      ++seed;
      Random random(seed);
      MaskCase c;
      const double scale = seed % 4 == 0 ? 0x1p-60 : seed % 4 == 1 ? 0x1p40 : 1;
      const dvec3 offset = seed % 4 == 2 ? dvec3(1e6, -2e6, 1e6) : dvec3(0);
      c.name = fmt::format("{}, sun kind {}, seed {}", maker.name, kind, seed);
      c.soup = maker.make(random).moved(scale, offset);
      c.light = sun_of_kind(kind, c.soup, random);
      c.config.simd = levels[seed % std::size(levels)];
      if (!simd_level_supported(c.config.simd)) c.config.simd = SimdLevel::automatic;
      c.view = view_from_light(c.light);
      c.points = points_on_triangles(c.soup, random, 3000);
      EXPECT_TRUE(exact(c, &shares));
      if (kind < 2) {
        c.points = points_behind_edges(c.soup, c.light, random, 1500);
        EXPECT_TRUE(exact(c, &shares));
      }
    }
  shares.print("soups under the sun");
  EXPECT_GT(shares.double_unknown, 100u) << "the adversary is too kind";
}

/// The room's light, moved away by `distance`.
MaskCase far_case(double distance, int kind, std::uint64_t seed, int size) {
  Random random(seed);
  MaskCase c;
  c.soup = room(random, 600);
  const dvec3 direction = kind == 0 ? dvec3(1, 0, 0) : glm::normalize(dvec3(0.3, 1, 0.2));
  c.light = point_light(dvec3(0.2, 1.6, -0.3) + distance * direction);
  c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, size, size);
  c.points = view_samples(c.soup.view(), c.view, size, size);
  c.name = fmt::format("room, light moved by {} ({}), seed {}", distance, kind, seed);
  return c;
}

TEST(ShadowMaskFarLight, IsExactAtPowersOfTen) {
  for (const int kind : {0, 1}) {
    for (int power = -18; power <= 18; power += 3) {
      const MaskCase c = far_case(std::pow(10.0, power), kind, 81, 96);
      EXPECT_TRUE(exact(c));
    }
    EXPECT_TRUE(exact(far_case(3e38, kind, 81, 96)));
  }
  for (int corner = 0; corner < 8; ++corner) {
    MaskCase c = far_case(1, 1, 82, 96);
    constexpr float far = std::numeric_limits<float>::max();
    c.light.position = {corner & 1 ? far : -far, corner & 2 ? far : -far, corner & 4 ? far : -far};
    c.name = fmt::format("corner {} of the float range", corner);
    EXPECT_TRUE(exact(c));
  }
}

TEST(ShadowMaskFarLight, IsExactOnEverySoup) {
  Shares shares;
  std::uint64_t seed = 7500;
  for (const SoupMaker& maker : soup_makers())
    for (const double distance : {30.0, 1e4, 1e9, 1e15}) {
      ++seed;
      Random random(seed);
      MaskCase c;
      c.name = fmt::format("{}, light {} extents away, seed {}", maker.name, distance, seed);
      c.soup = maker.make(random);
      const dvec3 low = c.soup.low(), size = c.soup.high() - low;
      c.light =
          point_light(low + 0.5 * size +
                      distance * glm::length(size) * direction_of_kind(static_cast<int>(seed % 3), random));
      c.config.simd = levels[seed % std::size(levels)];
      if (!simd_level_supported(c.config.simd)) c.config.simd = SimdLevel::automatic;
      c.view = view_from_light(c.light);
      c.points = points_on_triangles(c.soup, random, 2000);
      EXPECT_TRUE(exact(c, &shares));
      c.points = points_behind_edges(c.soup, c.light, random, 1000);
      EXPECT_TRUE(exact(c, &shares));
    }
  shares.print("soups under far lights");
}

// A lamp's own triangles around a light that is far from all points: near the light, and behind it.
TEST(ShadowMaskFarLight, IsExactAmongTrianglesAtTheLight) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Random random(seed);
    MaskCase c;
    const Soup seen = room(random, 100);
    c.soup = seen;
    const dvec3 at = 200.0 * random.direction();
    c.light = point_light(at);
    c.soup.append(random_soup(random, 200, 0.5).moved(1, at));
    c.soup.append(random_soup(random, 100, 0.3).moved(1000, dvec3(0)));
    c.view = view_from_light(c.light);
    c.points = points_on_triangles(seen, random, 3000);
    c.name = fmt::format("triangles at the light, seed {}", seed);
    EXPECT_TRUE(exact(c));
  }
}

// Against the same light 100 m away: which no bound that follows the distance would keep up with.
TEST(ShadowMaskFarLight, TakesNoMoreThanANearOne) {
  ShadowTracer tracer;
  traced(far_case(100, 1, 83, 160), tracer);
  const TraceStats near = tracer.stats();
  for (const double distance : {1e3, 1e6, 1e9, 1e12, 1e15, 1e18, 3e38}) {
    traced(far_case(distance, 1, 83, 160), tracer);
    const TraceStats& far = tracer.stats();
    EXPECT_EQ(tracer.ran(), Variant::tiles) << distance;
    EXPECT_LE(far.nodes, 2 * near.nodes) << distance;
    EXPECT_LE(far.leaf_tests, 2 * near.leaf_tests) << distance;
    EXPECT_LE(far.float_unknown, near.float_unknown + far.rays / 100) << distance;
    EXPECT_LE(far.double_unknown, near.double_unknown + far.rays / 1000) << distance;
  }
}

// Far along an axis, all walls and floors along it are lit at 10^-18 radians: many pairs are truly close, and
// all coplanar triangles before a point come near its ray. A few a ray all the same.
TEST(ShadowMaskFarLight, GrazesWithAFewCloseCallsARay) {
  ShadowTracer tracer;
  for (const double distance : {1e3, 1e6, 1e9, 1e12, 1e15, 1e18, 3e38}) {
    traced(far_case(distance, 0, 83, 160), tracer);
    const TraceStats& far = tracer.stats();
    EXPECT_EQ(tracer.ran(), Variant::tiles) << distance;
    EXPECT_LE(far.leaf_tests, 4 * far.rays) << distance;
    EXPECT_LE(far.double_unknown, 2 * far.rays) << distance;
  }
}

// Its cone and its range end amid the room; points with and without rows of positions.
TEST(ShadowMaskFarLight, KeepsItsConeAndRange) {
  for (const double distance : {100.0, 1e4, 1e6}) {
    MaskCase c = far_case(distance, 1, 88, 120);
    const dvec3 from(c.light.position);
    c.light.spot_axis = vec3(glm::normalize(dvec3(0.5, 0.1, 0.3) - from));
    c.light.spot_cos_outer = static_cast<float>(std::cos(0.8 / distance));
    c.name = fmt::format("spot {} m away, seed 88", distance);
    for (const float range_m : {0.0f, static_cast<float>(glm::length(from))}) {
      c.light.range_m = range_m;
      c.points = view_samples(c.soup.view(), c.view, 120, 120);
      const ShadowMask expected = oracle(c);
      EXPECT_TRUE(same_mask(c, traced(c), expected)) << range_m;
      const std::vector<std::uint32_t> ids = c.points.triangles;
      compute_visible_points(ids, 120, 120, c.view, c.soup.view(), c.points, PointLayout::tiles);
      ShadowTracer tracer;
      const ShadowMask mask = traced(c, tracer);
      EXPECT_EQ(tracer.ran(), Variant::tiles);
      EXPECT_EQ(differences(mask, expected).size(), 0u) << distance << " " << range_m;
    }
  }
}

TEST(ShadowMaskSun, IsTracedByTiles) {
  MaskCase c = far_case(0, 0, 84, 64);
  c.light = sun({0.3, 1, 0.2});
  ShadowTracer tracer;
  EXPECT_TRUE(same_mask(c, traced(c, tracer), oracle(c)));
  EXPECT_EQ(tracer.ran(), Variant::tiles);
  EXPECT_EQ(tracer.stats().lights_tiles, 1u);
  EXPECT_EQ(tracer.stats().lights_cones, 0u);
  const ShadowMask expected = oracle(c);
  const std::vector<std::uint32_t> ids = c.points.triangles;
  compute_visible_points(ids, 64, 64, c.view, c.soup.view(), c.points, PointLayout::tiles);
  ASSERT_TRUE(c.points.positions.empty());
  EXPECT_EQ(differences(traced(c, tracer), expected).size(), 0u);
  c.config.variant = Variant::spheres;
  traced(c, tracer);
  EXPECT_EQ(tracer.ran(), Variant::spheres);
  EXPECT_EQ(tracer.stats().lights_tiles, 0u);
  EXPECT_EQ(tracer.stats().lights_cones, 1u);
}

TEST(ShadowMaskSun, IsTheSameForThreadsAndInstructionSets) {
  MaskCase c = far_case(0, 0, 85, 200);
  for (const dvec3 direction : {dvec3(0.3, 1, 0.2), dvec3(-1, 0.01, 0), dvec3(0, 1, 0)}) {
    c.light = sun(direction);
    const ShadowMask expected = oracle(c);
    expect_same_at_levels_and_threads(c, expected);
    c.config.variant = Variant::precise_sorted;
    EXPECT_TRUE(same_mask(c, traced(c), expected));
    c.config.variant = Variant::tiles;
  }
}

TEST(ShadowMaskStop, EndsEveryVariantEarly) {
  MaskCase c = far_case(0, 0, 86, 64);
  StopFlag stop;
  ShadowMask mask;
  for (const Variant variant : all_variants) {
    c.config.variant = variant;
    stop.request();
    EXPECT_FALSE(
        ShadowTracer().trace_shadow_mask(c.points, c.view, c.soup.view(), c.light, c.config, mask, &stop));
    stop.reset();
    EXPECT_TRUE(
        ShadowTracer().trace_shadow_mask(c.points, c.view, c.soup.view(), c.light, c.config, mask, &stop));
    EXPECT_EQ(mask, oracle(c));
  }
}

// A light so far that the paper's way decides every pair exactly: minutes, unless it is stopped.
TEST(ShadowMaskStop, EndsWhatWouldTakeMinutes) {
  MaskCase c = far_case(1e15, 0, 87, 512);
  c.config.variant = Variant::precise_sorted;
  StopFlag stop;
  ShadowMask mask;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stop.request();
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(
      ShadowTracer().trace_shadow_mask(c.points, c.view, c.soup.view(), c.light, c.config, mask, &stop));
  later.join();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace
}  // namespace tenebra::testing
