// The variant Tiles beyond what all variants are tested for: buffers kept over moving frames, the order of
// triangles, where the method does not apply, threads and instruction sets.

#include <fmt/core.h>
#include <array>

#include "parallel/parallel.h"
#include "shadow/mask_case.h"
#include "shadow/rays/shadow_rays.h"
#include "shadow/tiles/cluster_order.h"
#include "shadow/tiles/triangle_clusters.h"

namespace tenebra::testing {
namespace {

MaskCase room_case(std::uint64_t seed, int width, int height) {
  Random random(seed);
  MaskCase c;
  c.name = fmt::format("room, seed {}", seed);
  c.soup = room(random, 600);
  c.light = point_light({0.2, 1.6, -0.3});
  c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, width, height);
  c.points = view_samples(c.soup.view(), c.view, width, height);
  return c;
}

/// An orthographic view of the same things.
ViewRays parallel_view(ViewRays v, int width, int height) {
  const glm::vec3 to_middle =
      0.5f * static_cast<float>(width) * v.dx + 0.5f * static_cast<float>(height) * v.dy;
  v.eye -= 2.0f * to_middle;
  v.d0 += to_middle;
  v.dx *= 2.0f, v.dy *= 2.0f;
  v.orthographic = true;
  return v;
}

/// What the paper's way says, from buffers of its own.
ShadowMask by_cone_tree(MaskCase c) {
  c.config.variant = Variant::precise_sorted;
  return traced(c);
}

TEST(Tiles, KeepTheirBuffersOverMovingFrames) {
  MaskCase c = room_case(71, 150, 90);
  Random random(72);
  ShadowTracer tracer;
  for (int frame = 0; frame < 12; ++frame) {
    c.name = fmt::format("moving room, frame {}", frame);
    const auto first = random.index(static_cast<std::uint32_t>(c.soup.positions.size() - 40));
    const glm::vec3 step(random.in_cube(0.1));
    for (std::uint32_t v = first; v < first + 40; ++v) c.soup.positions[v] += step;
    const auto id = random.index(static_cast<std::uint32_t>(c.soup.triangles.size()));
    if (frame % 3 == 1) c.soup.triangles[id] = glm::uvec3(0);  // hidden
    if (frame == 8) c.soup.append(random_soup(random, 50, 0.2));
    if (frame >= 5) c.soup.casts.assign(c.soup.triangles.size(), 1);
    if (frame == 6) c.soup.casts[id] = 0;
    c.points = view_samples(c.soup.view(), c.view, 150, 90);
    EXPECT_TRUE(same_mask(c, traced(c, tracer), by_cone_tree(c)));
  }
}

TEST(Tiles, TakeTheCallersWordThatNothingMoved) {
  MaskCase c = room_case(73, 64, 64);
  TriangleView view = c.soup.view();
  view.version = 7;
  ShadowTracer tracer;
  ShadowMask first, second, third;
  tracer.trace_shadow_mask(seen_from(c.points, c.view), view, c.light, {}, first);
  tracer.trace_shadow_mask(seen_from(c.points, c.view), view, c.light, {}, second);
  EXPECT_EQ(first, second);
  for (glm::vec3& p : c.soup.positions) p.y += p.y > 0 ? 0.3f : 0.0f;
  view = c.soup.view();
  view.version = 8;
  tracer.trace_shadow_mask(seen_from(c.points, c.view), view, c.light, {}, third);
  EXPECT_TRUE(same_mask(c, third, by_cone_tree(c)));
}

TEST(Tiles, OfSeveralTracersCanShareTheTreeOverTheTriangles) {
  MaskCase c = room_case(75, 160, 90);
  const std::size_t all = c.soup.triangles.size();
  std::array<ShadowTracer, 4> tracers;
  for (ShadowTracer& tracer : tracers) tracer.share_triangles(tracers[0]);
  std::array<ShadowMask, 4> masks;
  const auto light = [&](int i) { return point_light({0.3 * i - 0.5, 1.6, -0.3}); };
  for (std::uint64_t version = 1; version <= 3; ++version) {
    for (glm::vec3& p : c.soup.positions) p.y += p.y > 0 ? 0.05f : 0.0f;
    c.points = view_samples(c.soup.view(), c.view, 160, 90);
    TriangleView triangles = c.soup.view();
    triangles.version = version;
    ASSERT_TRUE(tracers[version].follow(triangles, SimdLevel::automatic));
    const std::vector<std::uint8_t> none(all, 0);
    triangles.casts_shadow = none;  // the word of the version counts, for the others too
    parallel::parallel_tasks(4, [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      tracers[k].trace_shadow_mask(seen_from(c.points, c.view), triangles, light(i), {}, masks[k]);
    });
    for (int i = 0; i < 4; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_EQ(tracers[k].stats().triangles, all);
      c.light = light(i);
      EXPECT_TRUE(same_mask(c, masks[k], by_cone_tree(c)));
    }
  }
}

TEST(Tiles, AreTheSameForThreadsAndInstructionSets) {
  const MaskCase c = room_case(74, 333, 211);
  expect_same_at_levels_and_threads(c, oracle(c));
}

TEST(Tiles, ReadPointsThatComeInTiles) {
  for (const glm::ivec2 size :
       {glm::ivec2{333, 211}, glm::ivec2{64, 48}, glm::ivec2{3, 2}, glm::ivec2{1100, 20}}) {
    MaskCase c = room_case(78, size.x, size.y);
    const ShadowMask expected = oracle(c);
    const std::vector<std::uint32_t> ids = c.points.triangles;
    compute_visible_points(ids, size.x, size.y, c.view, c.soup.view(), c.points, PointLayout::rows_and_tiles);
    ASSERT_FALSE(c.points.tiles.empty());
    EXPECT_TRUE(same_mask(c, traced(c), expected)) << size.x;
    // Of a light that some points cannot see, and for another eye, of which the tiles knew nothing.
    c.light.range_m = 1.5f;
    EXPECT_TRUE(same_mask(c, traced(c), oracle(c))) << size.x;
    c.view.eye = c.light.position;
    c.points.tiles.clear();
    EXPECT_TRUE(same_mask(c, traced(c), oracle(c))) << size.x;
  }
}

// Without positions in rows, the few that are asked for are worked out again: the same bits, for every
// variant and for lights that reach a part of what is seen.
TEST(Tiles, WorkOutThePositionsTheyAskFor) {
  for (const bool orthographic : {false, true}) {
    MaskCase c = room_case(80, 161, 97);
    if (orthographic) {
      c.view = parallel_view(c.view, 161, 97);
      c.points = view_samples(c.soup.view(), c.view, 161, 97);
    }
    compute_visible_points(std::vector<std::uint32_t>(c.points.triangles), 161, 97, c.view, c.soup.view(),
                           c.points, PointLayout::rows_and_tiles);
    MaskCase bare = c;
    compute_visible_points(c.points.triangles, 161, 97, c.view, c.soup.view(), bare.points,
                           PointLayout::tiles);
    ASSERT_TRUE(bare.points.positions.empty());
    for (std::size_t i = 0; i < c.points.positions.size(); ++i) {
      if (c.points.triangles[i] == no_triangle) continue;
      ASSERT_EQ(visible_position(bare.points, c.soup.view(), i), c.points.positions[i]) << i;
    }
    Random random(81);
    for (int light = 0; light < 12; ++light) {
      c.light.range_m = light % 3 == 1 ? static_cast<float>(random.in(0.5, 3)) : 0.0f;
      c.light.spot_cos_outer = light % 3 == 2 ? static_cast<float>(random.in(-0.9, 0.95)) : -1.0f;
      c.light.spot_axis = glm::vec3(random.direction());
      for (const Variant variant : {Variant::tiles, Variant::precise_sorted}) {
        c.config.variant = bare.config.variant = variant;
        bare.light = c.light;
        EXPECT_TRUE(same_mask(c, traced(bare), oracle(c))) << light;
      }
    }
  }
}

TEST(Tiles, ReachOfABallHoldsForItsPoints) {
  Random random(82);
  int found[3] = {};
  for (int i = 0; i < 3000; ++i) {
    ShadowLight light{.position = glm::vec3(0.0f)};
    if (random.chance(0.7)) light.range_m = static_cast<float>(random.in(0.2, 4));
    if (random.chance(0.7)) light.spot_cos_outer = static_cast<float>(random.in(-1, 1));
    light.spot_axis = glm::vec3(random.direction());
    const glm::dvec3 centre = random.in(0, 3) * random.direction();
    const double radius = std::pow(10.0, random.in(-4, 0.3));
    const shadow::Reach reach = shadow::reach_of_ball(centre, radius, light);
    ++found[static_cast<int>(reach)];
    for (int k = 0; reach != shadow::Reach::some && k < 50; ++k) {
      const glm::dvec3 p = centre + radius * random.direction();
      ASSERT_EQ(shadow::in_reach(p, light), reach == shadow::Reach::all) << i;
    }
  }
  for (const int count : found) EXPECT_GT(count, 200);
}

// Counted once each, however many roots meet them, and taken back when they get an area.
TEST(Tiles, CountWhatBlocksNothing) {
  MaskCase c = room_case(79, 200, 150);
  c.soup.casts.assign(c.soup.triangles.size(), 1);
  const auto degenerate = [&c](Variant variant, ShadowTracer& tracer, int threads) {
    c.config.variant = variant;
    with_threads(threads, [&] { traced(c, tracer); });
    return tracer.stats().degenerate_triangles;
  };
  ShadowTracer cones, tiles;
  const std::uint64_t before = degenerate(Variant::precise_sorted, cones, 1);
  EXPECT_LE(degenerate(Variant::tiles, tiles, 1), before);
  const auto first = static_cast<std::uint32_t>(c.soup.triangles.size());
  const double x = c.light.position.x;
  for (int i = 0; i < 5; ++i)  // edge-on to the light, all through the room
    c.soup.add({x, -1, 0.3 * i - 1.5}, {x, -0.4, 0.3 * i - 1.2}, {x, 0.7, 0.2 * i - 0.5});
  c.soup.add({-2, -2, -2}, {0, 0, 0}, {2, 2, 2});  // without area
  c.soup.casts.resize(c.soup.triangles.size(), 1);
  c.soup.triangles[3] = glm::uvec3(7);                       // hidden
  c.soup.casts[4] = 0, c.soup.triangles[4] = glm::uvec3(8);  // casts nothing anyway
  const std::uint64_t expected = degenerate(Variant::precise_sorted, cones, 1);
  EXPECT_GE(expected, before + 7);
  for (const int threads : {1, 3}) EXPECT_EQ(degenerate(Variant::tiles, tiles, threads), expected);
  for (std::uint32_t i = first; i < c.soup.triangles.size(); ++i) c.soup.triangles[i] = glm::uvec3(0);
  EXPECT_EQ(degenerate(Variant::tiles, tiles, 1), degenerate(Variant::precise_sorted, cones, 1));
}

// A light low in the middle of a field of boxes that is seen from afar: pixels side by side lie in all
// directions from it. Tiles as they stand are then tested with most of the field's triangles.
TEST(Tiles, AreSplitWhereTheyAreWideFromTheLight) {
  MaskCase c;
  c.soup.quad({-41, 0, 41}, {82, 0, 0}, {0, 0, -82});
  for (int x = -20; x < 20; ++x) {
    for (int z = -20; z < 20; ++z)
      c.soup.append(box({2 * x + 0.5, 0, 2 * z + 0.5}, {2 * x + 1.25, 0.5, 2 * z + 1.5}));
  }
  c.light = point_light({0.1, 0.75, 0.2});
  c.view = pinhole({60, 50, 60}, {0, 0, 0}, 0.8, 96, 96);
  c.points = view_samples(c.soup.view(), c.view, 96, 96);
  ShadowTracer tracer;
  EXPECT_TRUE(same_mask(c, traced(c, tracer), oracle(c)));
  const double rays = static_cast<double>(tracer.stats().rays);
  EXPECT_GT(rays, 1000);
  EXPECT_LT(static_cast<double>(tracer.stats().leaf_tests), 8 * rays);
}

// Points here and there on a layer of many tiny triangles, the light above it and between them: most
// triangles are far from all rays and must be left behind many at a time. From above a ray takes 23 tests of
// sixteen boxes; it takes 54 where triangles are always descended first.
TEST(Tiles, ReachFewRaysAmongManyTriangles) {
  Random random(80);
  MaskCase c;
  c.soup = random_soup(random, 60000, 0.01);
  for (glm::vec3& p : c.soup.positions) p.y *= 0.01f;
  c.points = points_on_triangles(c.soup, random, 256);
  for (const double height : {4.0, 0.02}) {
    c.light = point_light({0.4, height, 0.3});
    c.view = view_from_light(c.light);
    const ShadowMask expected = by_cone_tree(c);
    for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::avx2, SimdLevel::automatic}) {
      if (!simd_level_supported(level)) continue;
      c.config.simd = level;
      for (const int threads : {1, 3}) {
        ShadowTracer tracer;
        with_threads(threads, [&] { EXPECT_TRUE(same_mask(c, traced(c, tracer), expected)) << threads; });
        EXPECT_EQ(tracer.stats().rays, 256u);
        EXPECT_GT(tracer.stats().shadowed_pixels, 20u);
        if (height > 1) {
          EXPECT_LT(tracer.stats().nodes, 256u * 16 * 36);
        }
      }
    }
  }
}

TEST(Tiles, GiveWayWhereTheyDoNotApply) {
  MaskCase c = room_case(75, 64, 64);
  c.light = sun({0.3, 1, 0.2});
  EXPECT_TRUE(same_mask(c, traced(c), oracle(c)));
  c = room_case(75, 64, 64);
  for (const double scale : {0x1p-100, 0x1p70}) {
    MaskCase scaled = c;
    scaled.soup = c.soup.moved(scale, glm::dvec3(0));
    scaled.light.position = glm::vec3(glm::dvec3(c.light.position) * scale);
    scaled.view = view_from_light(scaled.light);
    for (glm::dvec3& p : scaled.points.positions) p *= scale;
    EXPECT_TRUE(same_mask(scaled, traced(scaled), oracle(scaled)));
  }
}

TEST(Tiles, LightAmongTheSamplesFacesAllSidesOfTheCube) {
  Random random(76);
  MaskCase c;
  c.soup = sphere(8, 2, glm::dvec3(0));
  c.soup.append(random_soup(random, 300, 0.3));
  c.points = points_on_triangles(c.soup, random, 5000);
  for (int i = 0; i < 8; ++i) {
    c.light = point_light(random.in_cube(i < 4 ? 0.5 : 1e-3));
    c.view = view_from_light(c.light);
    c.name = fmt::format("light {} inside, seed 76", i);
    EXPECT_TRUE(same_mask(c, traced(c), oracle(c)));
  }
}

TEST(ClusterOrder, HoldsEveryCasterOnce) {
  Random random(77);
  Soup soup = room(random, 500);
  soup.casts.assign(soup.triangles.size(), 1);
  for (std::size_t i = 0; i < soup.casts.size(); i += 7) soup.casts[i] = 0;
  std::vector<std::uint32_t> order;
  const std::vector<std::uint32_t> parts{0, 12, 100};
  TriangleView view = soup.view();
  view.parts = parts;
  shadow::cluster_order(view, order, nullptr);
  EXPECT_EQ(order.size() % shadow::cluster_size, 0u);
  std::vector<int> met(soup.triangles.size(), 0);
  for (const std::uint32_t id : order)
    if (id != no_triangle) ++met[id];
  for (std::size_t i = 0; i < met.size(); ++i) EXPECT_EQ(met[i], soup.casts[i] != 0 ? 1 : 0) << i;
}

}  // namespace
}  // namespace tenebra::testing
