// Points and triangles of the caller's own: the tracers' answers for the same points, known answers, and
// sentences.
#include <gtest/gtest.h>

#include <tenebra/queries.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "points/triangle_corners.h"
#include "support/samples.h"
#include "support/soup.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;
using testing::Random;
using testing::Soup;

Geometry geometry_of(const Soup& soup) {
  auto made = Geometry::create(soup.positions, soup.triangles, soup.casts);
  EXPECT_TRUE(made.has_value());
  return std::move(*made);
}

/// A floor of 18 x 18 metres at y = 0, and over x < 0 a plate at y = 2.
Soup floor_and_plate() {
  Soup soup;
  soup.quad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  soup.quad({-5, 2, 5}, {5, 0, 0}, {0, 0, -10});
  return soup;
}

AreaLight square_light() {
  return make_rectangle_light({0, 4, 0}, {1, 0, 0}, {0, 0, 1}).value();
}

std::vector<std::uint8_t> hard_mask(PointTracer& tracer, const Geometry& geometry, const QueryPoints& points,
                                    const ShadowLight& light) {
  std::vector<std::uint8_t> mask(points.positions.size(), 7);
  const auto done = tracer.hard_mask(geometry, points, light, {}, mask);
  EXPECT_TRUE(done.has_value()) << done.error().message;
  return mask;
}

struct Soft {
  std::vector<float> fraction, irradiance;
};
Soft soft(PointTracer& tracer, const Geometry& geometry, const QueryPoints& points, const AreaLight& light) {
  Soft out{std::vector<float>(points.positions.size(), -1), std::vector<float>(points.positions.size(), -1)};
  const auto done = tracer.soft_visibility(geometry, points, light, {}, out.fraction, out.irradiance);
  EXPECT_TRUE(done.has_value()) << done.error().message;
  return out;
}

/// What a view sees of a soup, as points to ask about.
struct Seen {
  Soup soup;
  ViewRays view;
  VisiblePoints visible;
  std::vector<std::int8_t> sides;

  explicit Seen(std::uint64_t seed) {
    Random random(seed);
    soup = testing::room(random, 6);
    view = testing::pinhole({0.6, 0.7, 0.8}, {0, 0, 0}, 0.8, 96, 64);
    visible = testing::view_samples(soup.view(), view, 96, 64);
    for (const std::uint32_t id : visible.triangles)
      sides.push_back(static_cast<std::int8_t>(
          id == no_triangle ? 0 : points::eye_side(points::corners_of(soup.view(), id).v, view)));
  }
  QueryPoints points(int width) const {
    return {.positions = visible.positions, .triangles = visible.triangles, .sides = sides, .width = width};
  }
};

TEST(PointTracer, HardMasksHaveTheBytesOfTheTracer) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const Seen seen(seed);
    const Geometry geometry = geometry_of(seen.soup);
    PointTracer tracer;
    for (const ShadowLight& light :
         {ShadowLight{.position = {0.2f, 0.9f, -0.3f}},
          ShadowLight{.directional = true, .to_light = {0.3f, 1, 0.2f}},
          ShadowLight{.position = {0.2f, 0.9f, 0.1f}, .spot_cos_outer = 0.8f, .range_m = 1.6f}}) {
      ShadowMask expected;
      ShadowTracer().trace_shadow_mask(seen.visible, seen.soup.view(), light, {}, expected);
      for (const int width : {96, 0}) {
        const auto mask = hard_mask(tracer, geometry, seen.points(width), light);
        for (std::size_t i = 0; i < mask.size(); ++i) {
          if (seen.visible.triangles[i] == no_triangle) continue;  // here a point in the air
          ASSERT_EQ(mask[i], expected[i]) << i;
        }
      }
    }
  }
}

// Points on triangles with and without a side, and free ones that face some of the lights.
TEST(PointTracer, ManyLightsGiveTheMasksOfEach) {
  Seen seen(4);
  std::vector<ShadowLight> lights;
  for (const float x : {-0.6f, -0.5f, 0.4f, 2.0f})
    lights.push_back({.directional = true, .to_light = {x, 1, 0.2f}});
  lights.push_back({.position = {0.2f, 0.9f, -0.3f}});
  std::vector<vec3> normals(seen.sides.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (i % 5 == 0) seen.visible.triangles[i] = no_triangle, normals[i] = vec3(1, -0.4f, 0);
    if (i % 3 == 0) seen.sides[i] = 0;
  }
  QueryPoints points = seen.points(0);
  points.normals = normals;
  const Geometry geometry = geometry_of(seen.soup);
  PointTracer many, single;
  std::size_t used = 0, lit = 0;
  const auto compare = [&](std::size_t light, std::span<const std::uint8_t> mask) {
    EXPECT_EQ(light, used++);
    const auto expected = hard_mask(single, geometry, points, lights[light]);
    EXPECT_TRUE(std::equal(mask.begin(), mask.end(), expected.begin(), expected.end())) << light;
    lit += static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 255));
  };
  ASSERT_TRUE(many.hard_masks(geometry, points, lights, {}, compare).has_value());
  EXPECT_EQ(used, lights.size());
  EXPECT_GT(lit, 0u);
  lights[1].to_light = vec3(0.0f);
  EXPECT_FALSE(many.hard_masks(geometry, points, lights, {}, compare).has_value());
}

// Which are asked about once for all lights; a count that no four points make up.
TEST(PointTracer, ManyLightsGiveTheMasksOfEachForPointsThatSayTheirSides) {
  Seen seen(4);
  const std::size_t count = seen.sides.size() / 4 * 4 - 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (seen.visible.triangles[i] == no_triangle) seen.visible.triangles[i] = 0;
    seen.sides[i] = i % 7 == 0 ? -1 : 1;
  }
  QueryPoints points = seen.points(0);
  points.positions = points.positions.first(count), points.triangles = points.triangles.first(count);
  points.sides = points.sides.first(count);
  const std::vector<ShadowLight> lights{{.directional = true, .to_light = {0.4f, 1, 0.2f}},
                                        {.directional = true, .to_light = {-0.6f, -1, 0.2f}},
                                        {.position = {0.2f, 0.9f, -0.3f}}};
  const Geometry geometry = geometry_of(seen.soup);
  PointTracer many, single;
  std::size_t lit = 0;
  const auto compare = [&](std::size_t light, std::span<const std::uint8_t> mask) {
    const auto expected = hard_mask(single, geometry, points, lights[light]);
    EXPECT_TRUE(std::equal(mask.begin(), mask.end(), expected.begin(), expected.end())) << light;
    lit += static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 255));
  };
  ASSERT_TRUE(many.hard_masks(geometry, points, lights, {}, compare).has_value());
  EXPECT_GT(lit, 0u);
}

TEST(PointTracer, SoftFractionsAreThoseOfTheTracer) {
  const Seen seen(3);
  const AreaLight light = make_rectangle_light({0.1f, 0.9f, -0.2f}, {0.2f, 0, 0}, {0, 0, 0.2f}).value();
  SoftMask expected;
  SoftShadowTracer().trace(seen.visible, {}, seen.soup.view(), light, {}, expected);
  PointTracer tracer;
  for (const int width : {96, 0}) {
    const Soft found = soft(tracer, geometry_of(seen.soup), seen.points(width), light);
    for (std::size_t i = 0; i < found.fraction.size(); ++i) {
      if (seen.visible.triangles[i] == no_triangle) continue;
      ASSERT_NEAR(found.fraction[i], expected.visible_fraction[i], 1e-3) << i;
      ASSERT_NEAR(found.irradiance[i], expected.irradiance[i], 1e-3) << i;
    }
  }
}

TEST(PointTracer, SunsAreSeenFromEachSide) {
  const Soup soup = floor_and_plate();
  const Geometry geometry = geometry_of(soup);
  const AreaLight sun = make_sun({0, 1, 0}, 10).value();
  // In the open, under the edge of the plate, under the plate; and the floor's other side.
  const std::vector<dvec3> at{{4, 0, 3}, {0, 0, -2}, {-3, 0, -2}, {4, 0, 3}};
  const std::vector<std::uint32_t> on(4, 0);
  const std::vector<std::int8_t> sides{1, 1, 1, -1};
  std::vector<float> fraction(4), irradiance(4);
  ASSERT_TRUE(PointTracer().soft_visibility(geometry, {.positions = at, .triangles = on, .sides = sides}, sun,
                                            {}, fraction, irradiance));
  EXPECT_EQ(fraction[0], 1.0f);
  EXPECT_NEAR(fraction[1], 0.5f, 1e-5f);
  EXPECT_EQ(fraction[2], 0.0f);
  EXPECT_EQ(fraction[3], 0.0f);
  EXPECT_NEAR(irradiance[0], sun.area_m2, 1e-3 * sun.area_m2);
}

TEST(PointTracer, PointsInTheAir) {
  const Geometry geometry = geometry_of(floor_and_plate());
  const ShadowLight light{.position = {0, 4, 0}};
  // The plate's shadow ends at x = 0, and 2 metres below it at twice its extent.
  const std::vector<dvec3> positions{{-1, 1, 0}, {1, 1, 0},   {-1, 3, 0}, {-8.5, 1, 0},
                                     {0, 4, 0},  {-1, -1, 0}, {1, -1, 0}};
  PointTracer tracer;
  EXPECT_EQ(hard_mask(tracer, geometry, {.positions = positions}, light),
            (std::vector<std::uint8_t>{0, 255, 255, 255, 255, 0, 0}));
  const std::vector<vec3> up(positions.size(), vec3(0, 3, 0)), down(positions.size(), vec3(0, -1, 0));
  EXPECT_EQ(hard_mask(tracer, geometry, {.positions = positions, .normals = up}, light)[1], 255);
  EXPECT_EQ(hard_mask(tracer, geometry, {.positions = positions, .normals = down}, light)[1], 0);

  // Half of the light is seen past the plate's edge, from any height.
  const std::vector<dvec3> below{{0, 1, 0}, {0, 0.5, 1}, {4, 1, 0}, {-2, 1, 0}, {0, 5, 0}};
  const Soft found = soft(tracer, geometry, {.positions = below}, square_light());
  const std::vector<float> expected{0.5f, 0.5f, 1, 0, 0};
  for (std::size_t i = 0; i < below.size(); ++i) EXPECT_NEAR(found.fraction[i], expected[i], 1e-5) << i;
}

TEST(PointTracer, BothSidesOfAWallThatCutsTheLight) {
  Soup soup;
  soup.quad({0.25, 0, -1}, {0, 0, 2}, {0, 1, 0});  // in the plane x = 0.25, the light above from -1 to 1
  const Geometry geometry = geometry_of(soup);
  const std::vector<dvec3> positions(2, dvec3(0.25, 0.5, 0.1));
  const std::vector<std::uint32_t> triangles(2, 0);
  const std::vector<std::int8_t> sides{1, -1};
  PointTracer tracer;
  const Soft found = soft(tracer, geometry, {.positions = positions, .triangles = triangles, .sides = sides},
                          square_light());
  EXPECT_NEAR(std::min(found.fraction[0], found.fraction[1]), 0.375, 1e-5);
  EXPECT_NEAR(std::max(found.fraction[0], found.fraction[1]), 0.625, 1e-5);
  const std::vector<vec3> normals{{1, 0, 0}, {-1, 0, 0}};  // the same without a triangle
  const Soft apart = soft(tracer, geometry, {.positions = positions, .normals = normals}, square_light());
  EXPECT_NEAR(apart.fraction[0], 0.375, 1e-4);
  EXPECT_NEAR(apart.fraction[1], 0.625, 1e-4);
  EXPECT_GT(apart.irradiance[1], apart.irradiance[0]);
}

TEST(PointTracer, OcclusionWithAndWithoutTriangles) {
  Soup soup;
  soup.quad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  soup.quad({-9, 0.5, 9}, {9, 0, 0}, {0, 0, -18});
  Geometry geometry = geometry_of(soup);
  const std::vector<dvec3> positions{{-4, 0, -5}, {4, 0, 5}};
  const std::vector<std::uint32_t> triangles{1, 0};
  const std::vector<vec3> up(2, vec3(0, 1, 0));
  const AoConfig config{.error_255 = 0.5, .distance_m = 1.0};
  PointTracer tracer;
  const auto ask = [&](const QueryPoints& points) {
    std::vector<float> open(points.positions.size());
    const auto done = tracer.ambient_occlusion(geometry, points, config, open);
    EXPECT_TRUE(done.has_value()) << done.error().message;
    return open;
  };
  // Under an endless ceiling at height h that hides linearly up to 1 m, 1 - (1 - h)^2 is left.
  for (const QueryPoints& points : {QueryPoints{.positions = positions, .triangles = triangles},
                                    QueryPoints{.positions = positions, .normals = up}}) {
    const std::vector<float> open = ask(points);
    EXPECT_NEAR(open[0], 0.75, 0.01);
    EXPECT_EQ(open[1], 1.0f);
  }
  for (vec3& p : soup.positions)
    if (p.y == 0.5f) p.y = 0.25f;
  ASSERT_TRUE(geometry.move_vertices(soup.positions).has_value());
  EXPECT_NEAR(ask({.positions = positions, .triangles = triangles})[0], 0.4375, 0.01);
  EXPECT_NEAR(ask({.positions = positions, .normals = up})[0], 0.4375, 0.01);
}

TEST(PointTracer, MovedTrianglesAreMetWhereTheyAre) {
  Soup soup = floor_and_plate();
  Geometry geometry = geometry_of(soup);
  PointTracer tracer;
  const std::vector<dvec3> positions{{-1, 1, 0}, {1, 1, 0}};
  const ShadowLight light{.directional = true, .to_light = {0, 1, 0}};
  EXPECT_EQ(hard_mask(tracer, geometry, {.positions = positions}, light), (ShadowMask{0, 255}));
  for (vec3& p : soup.positions)
    if (p.y == 2) p.x += 5;
  ASSERT_TRUE(geometry.move_vertices(soup.positions).has_value());
  EXPECT_EQ(hard_mask(tracer, geometry, {.positions = positions}, light), (ShadowMask{255, 0}));
  EXPECT_FALSE(geometry.move_vertices(std::span(soup.positions).first(3)).has_value());
}

TEST(PointTracer, AnyNumberOfPoints) {
  const Geometry geometry = geometry_of(floor_and_plate());
  const ShadowLight light{.directional = true, .to_light = {0, 1, 0}};
  PointTracer tracer;
  EXPECT_TRUE(hard_mask(tracer, geometry, {}, light).empty());
  std::vector<dvec3> positions;
  std::vector<std::uint8_t> expected;
  Random random(4);
  for (int i = 0; i < (1 << 18) + 1234; ++i) {
    positions.emplace_back(random.in(-4.9, 4.9), 1, random.in(-4.9, 4.9));
    expected.push_back(positions.back().x < 0 ? 0 : 255);
  }
  std::vector<double> progress;
  std::vector<std::uint8_t> mask(positions.size());
  ASSERT_TRUE(tracer
                  .hard_mask(geometry, {.positions = positions}, light, {}, mask, nullptr,
                             [&](double done) { progress.push_back(done); })
                  .has_value());
  EXPECT_EQ(mask, expected);
  ASSERT_EQ(progress.size(), 2u);
  EXPECT_EQ(progress.back(), 1.0);
}

TEST(PointTracer, StopsWhenAsked) {
  const Geometry geometry = geometry_of(floor_and_plate());
  const std::vector<dvec3> positions{{1, 1, 0}};
  std::vector<std::uint8_t> mask(1);
  StopFlag stop;
  stop.request();
  const auto done = PointTracer().hard_mask(geometry, {.positions = positions}, {}, {}, mask, &stop);
  ASSERT_FALSE(done.has_value());
  EXPECT_TRUE(is_stop(done));
}

/// The floor and the plate moved by whole metres, as doubles, and points on the floor.
struct Moved {
  dvec3 by;
  Soup soup = floor_and_plate();
  std::vector<dvec3> positions, at;
  std::vector<std::uint32_t> on;

  explicit Moved(const dvec3& offset) : by(offset) {
    for (const vec3& p : soup.positions) positions.push_back(dvec3(p) + by);
    for (int i = 0; i < 256; ++i) {
      at.push_back(by + dvec3(0.5 * (i % 16) - 6, 0, 0.5 * (i / 16) - 4));
      on.push_back(0.5 * (i % 16) - 6 + 0.5 * (i / 16) - 4 > 0 ? 0 : 1);
    }
  }
  Geometry geometry() const { return Geometry::create(positions, soup.triangles).value(); }
};

TEST(PointTracer, GivesTheSameBitsFarFromTheOrigin) {
  const Moved here({0, 0, 0}), there({691200, 0, 5334600});
  const Geometry near = here.geometry(), far = there.geometry();
  EXPECT_EQ(near.origin(), dvec3(0));
  EXPECT_EQ(far.origin(), there.by);
  const QueryPoints near_points{.positions = here.at, .triangles = here.on},
      far_points{.positions = there.at, .triangles = here.on};
  PointTracer tracer;
  const ShadowLight sun{.directional = true, .to_light = {0.3f, 1, 0.2f}};
  const auto mask = hard_mask(tracer, near, near_points, sun);
  EXPECT_GT(std::count(mask.begin(), mask.end(), 0), 20);
  EXPECT_EQ(mask, hard_mask(tracer, far, far_points, sun));
  const Soft share = soft(tracer, near, near_points, square_light()),
             far_share = soft(tracer, far, far_points, square_light());
  EXPECT_EQ(share.fraction, far_share.fraction);
  EXPECT_EQ(share.irradiance, far_share.irradiance);
  std::vector<float> open(here.at.size()), far_open(here.at.size());
  ASSERT_TRUE(tracer.ambient_occlusion(near, near_points, {}, open));
  ASSERT_TRUE(tracer.ambient_occlusion(far, far_points, {}, far_open));
  EXPECT_EQ(open, far_open);
}

TEST(PointTracer, KeepsTheOriginWhereVerticesMove) {
  const Moved there({691200, 0, 5334600});
  Geometry geometry = there.geometry();
  std::vector<dvec3> raised = there.positions;
  for (dvec3& p : raised) p.x += 100;
  ASSERT_TRUE(geometry.move_vertices(raised));
  EXPECT_EQ(geometry.origin(), there.by);
  EXPECT_EQ(geometry.view().positions[0], there.soup.positions[0] + vec3(100, 0, 0));
}

TEST(PointTracer, SaysWhatIsWrong) {
  const std::vector<vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<glm::uvec3> one{{0, 1, 2}}, beyond{{0, 1, 3}};
  EXPECT_EQ(Geometry::create(corners, beyond).error().message,
            "geometry: triangle 0 has the vertices 0, 1 and 3, expected numbers below 3");
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<vec3> lost{{0, 0, 0}, {1, nan, 0}, {0, 1, 0}};
  EXPECT_EQ(Geometry::create(lost, one).error().message,
            "geometry: vertex 1 is (1, nan, 0), expected finite coordinates of at most 1e18");

  const Geometry geometry = Geometry::create(corners, one).value();
  const auto sentence = [&](const QueryPoints& points, const ShadowLight& light = {}) {
    std::vector<std::uint8_t> mask(points.positions.size());
    const auto done = PointTracer().hard_mask(geometry, points, light, {}, mask);
    return done ? std::string() : done.error().message;
  };
  const std::vector<dvec3> two(2, dvec3(0.5)), infinite{dvec3(1, HUGE_VAL, 0)};
  const std::vector<std::uint32_t> ids{0, 1}, short_ids{0};
  const std::vector<std::int8_t> sides{1, 2};
  EXPECT_EQ(sentence({.positions = two, .triangles = short_ids}),
            "points: found 1 triangles, expected one for each of 2 points, or none");
  EXPECT_EQ(sentence({.positions = two, .triangles = ids}),
            "points: point 1 lies on triangle 1, expected a number below 1 or none");
  EXPECT_EQ(sentence({.positions = infinite}),
            "points: point 0 is at (1, inf, 0), expected finite coordinates of at most 1e18");
  EXPECT_EQ(sentence({.positions = two, .sides = sides}),
            "points: the side of point 1 is 2, expected 1, -1 or 0");
  EXPECT_EQ(sentence({.positions = two, .width = 3}),
            "points: found 2 points and a width of 3, expected whole rows");
  EXPECT_EQ(sentence({.positions = two}, {.directional = true, .to_light = vec3(0)}),
            "light: its direction is (0, 0, 0), expected a finite one that is not zero");
  std::vector<float> open(2);
  EXPECT_EQ(PointTracer().ambient_occlusion(geometry, {.positions = two}, {}, open).error().message,
            "ambient occlusion: point 0 has neither a triangle nor a normal, expected one of them");
}

}  // namespace
}  // namespace tenebra
