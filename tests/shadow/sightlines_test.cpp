// Sightlines agree with the mask, and name the triangle that a ray of rationals meets first.
#include <fmt/core.h>
#include <gmpxx.h>
#include <gtest/gtest.h>

#include "points/triangle_corners.h"
#include "shadow/mask_case.h"
#include "shadow/rays/sightlines.h"
#include "support/round_bodies.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using shadow::LightSight;
using shadow::Sample;
using shadow::Sightline;

struct Rational {
  mpq_class x, y, z;
  template <class V>
  explicit Rational(const V& v) : x(double(v.x)), y(double(v.y)), z(double(v.z)) {}
  Rational(mpq_class a, mpq_class b, mpq_class c) : x(std::move(a)), y(std::move(b)), z(std::move(c)) {}
};
Rational operator-(const Rational& a, const Rational& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
mpq_class dot(const Rational& a, const Rational& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Rational cross(const Rational& a, const Rational& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// How far along its ray the sample's line meets the triangle's plane, in rationals.
mpq_class meeting(const MaskCase& c, const dvec3& point, std::uint32_t id) {
  const Rational a(c.soup.corner(id, 0)), p(point);
  const Rational n = cross(Rational(c.soup.corner(id, 1)) - a, Rational(c.soup.corner(id, 2)) - a);
  const Rational way = c.light.directional ? Rational(c.light.to_light) : Rational(c.light.position) - p;
  return dot(n, a - p) / dot(n, way);
}

/// All triangles by brute force: every one asked, the meetings compared as fractions.
Sightline by_force(const MaskCase& c, const oracle::ExactShadow& oracle, const Sample& sample) {
  oracle::ExactMaskStats stats;
  Sightline line;
  mpq_class nearest;
  for (std::uint32_t id = 0; id < c.soup.triangles.size(); ++id) {
    if (!oracle.blocks(id, sample.point, sample.triangle, stats)) continue;
    ++line.blockers;
    line.sight = LightSight::blocked;
    mpq_class at = meeting(c, sample.point, id);
    if (line.first != no_triangle && at >= nearest) continue;
    line.first = id;
    nearest = std::move(at);
  }
  return line;
}

struct SightCounts {
  int blocked = 0, lit = 0, inactive = 0;
};

/// Every sample of `c` beside brute force and beside the mask of the tracer.
void expect_first_blockers(const MaskCase& c, SightCounts& counts) {
  const oracle::ExactShadow oracle(c.view, c.soup.view(), c.light, c.config);
  const ShadowMask mask = traced(c);
  for (std::size_t i = 0; i < c.points.triangles.size(); ++i) {
    Sample sample{c.points.positions[i], c.points.triangles[i]};
    if (sample.triangle == no_triangle) continue;
    sample.side = points::eye_side(points::corners_of(c.soup.view(), sample.triangle).v, c.view);
    const Sightline line = shadow::find_sightlines(sample, c.soup.view(), {&c.light, 1}, c.config).front();
    ASSERT_EQ(line.sight == LightSight::lit, mask[i] == 255) << c.name << ", sample " << i;
    const bool active = oracle.active(sample.point, sample.triangle);
    ASSERT_EQ(line.sight == LightSight::faces_away || line.sight == LightSight::out_of_reach, !active)
        << c.name << ", sample " << i;
    if (!active) {
      ++counts.inactive;
      continue;
    }
    const Sightline expected = by_force(c, oracle, sample);
    ASSERT_EQ(line.sight, expected.sight) << c.name << ", sample " << i;
    ASSERT_EQ(line.blockers, expected.blockers) << c.name << ", sample " << i;
    ASSERT_EQ(line.first, expected.first) << c.name << ", sample " << i;
    ++(expected.blockers > 0 ? counts.blocked : counts.lit);
  }
}

TEST(Sightlines, NameTheFirstBlockerOfEverySoup) {
  SightCounts counts;
  std::uint64_t seed = 7000;
  for (const SoupMaker& maker : soup_makers()) {
    for (int kind = 0; kind < 4; ++kind) {
      ++seed;
      Random random(seed);
      MaskCase c;
      c.name = fmt::format("{}, light kind {}, seed {}", maker.name, kind, seed);
      c.soup = maker.make(random);
      if (kind == 3) c.soup = c.soup.moved(0x1p-30, dvec3(0));
      if (seed % 3 == 0)
        for (std::size_t i = 0; i < c.soup.triangles.size(); ++i) c.soup.casts.push_back(random.chance(0.8));
      const dvec3 low = c.soup.low(), size = c.soup.high() - low;
      const dvec3 inside = low + size * dvec3(random.unit(), random.unit(), random.unit());
      c.light = kind == 1 ? sun(random.direction()) : point_light(kind == 2 ? inside : low + 1.3 * size);
      c.config.cull_front = seed % 7 == 0;
      c.view = view_from_light(c.light);
      c.points = kind == 3 ? points_behind_edges(c.soup, c.light, random, 36)
                           : points_on_triangles(c.soup, random, 36);
      expect_first_blockers(c, counts);
    }
  }
  EXPECT_GT(counts.blocked, 300);
  EXPECT_GT(counts.lit, 100);
  EXPECT_GT(counts.inactive, 0);
}

TEST(Sightlines, KnowConesRangesAndDoublePlanes) {
  MaskCase c;
  c.soup.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});  // a floor, seen from above
  for (int copy = 0; copy < 3; ++copy) c.soup.quad({-0.5, 1, -0.5}, {0, 0, 1}, {1, 0, 0});
  c.soup.quad({-0.5, 1.5, -0.5}, {0, 0, 1}, {1, 0, 0});
  c.light = point_light({0, 2, 0});
  c.view = pinhole({0.1, 3, 0.1}, {0, 0, 0.01}, 1, 8, 8);
  const auto sight = [&](dvec3 point, std::uint32_t triangle) {
    const int side = points::eye_side(points::corners_of(c.soup.view(), triangle).v, c.view);
    return shadow::find_sightlines({point, triangle, side}, c.soup.view(), {&c.light, 1}, c.config).front();
  };
  const Sightline below = sight({0.1, 0, 0.05}, 0);
  EXPECT_EQ(below.sight, LightSight::blocked);
  EXPECT_GE(below.blockers, 4u);
  EXPECT_LT(below.first, 8u) << "the nearer of the two heights";
  EXPECT_NEAR(below.met_at.y, 1, 1e-12);
  std::uint32_t smallest = no_triangle;
  for (std::uint32_t id = 2; id < 8; ++id) {
    oracle::ExactMaskStats stats;
    const oracle::ExactShadow oracle(c.view, c.soup.view(), c.light, c.config);
    if (smallest == no_triangle && oracle.blocks(id, {0.1, 0, 0.05}, 0, stats)) smallest = id;
  }
  EXPECT_EQ(below.first, smallest) << "of those that lie in one another the first";
  EXPECT_EQ(sight({0.1, 1, 0.05}, below.first).first, 8u + (below.first - 2) % 2)
      << "a copy in the same place does not block";
  c.light.range_m = 1;
  EXPECT_EQ(sight({0.1, 0, 0.05}, 0).sight, LightSight::out_of_reach);
  c.light.range_m = 0;
  c.light.spot_axis = {0, 1, 0};
  c.light.spot_cos_outer = 0.5f;
  EXPECT_EQ(sight({0.1, 0, 0.05}, 0).sight, LightSight::out_of_reach);
  c.light = point_light({0, -2, 0});
  EXPECT_EQ(sight({0.1, 0, 0.05}, 0).sight, LightSight::faces_away);
}

TEST(Sightlines, AgreeWithTheMaskOfLiftedPoints) {
  RoundBody body = round_body(10, 16, {0, 1.2, 0}, 0.15);
  add_floor(body, 0, 6);
  constexpr int width = 64, height = 56;
  const ViewRays view = pinhole({1, 2.5, 5}, {0, 1, 0}, 0.7, width, height);
  const VisiblePoints ids = view_samples(body.flat(), view, width, height);
  VisiblePoints points;
  compute_visible_points(ids.triangles, width, height, view, body.smooth(), points);
  std::size_t lit_beyond = 0, away = 0;
  for (const ShadowLight& light :
       {point_light({6, 3, 1}), point_light({-2, 2.6, -3}), sun({-1, 0.4, -0.3})}) {
    ShadowMask mask;
    ShadowTracer tracer;
    tracer.trace_shadow_mask(seen_from(points, view), body.smooth(), light, {}, mask);
    for (std::size_t i = 0; i < mask.size(); ++i) {
      if (points.triangles[i] == no_triangle) continue;
      const Sample sample{points.positions[i], points.triangles[i], visible_side(points, body.smooth(), i)};
      const Sightline line = shadow::find_sightlines(sample, body.smooth(), {&light, 1}, {}).front();
      ASSERT_EQ(line.sight == LightSight::lit, mask[i] == 255) << i;
      const bool flat_active = shadow::find_sightlines(sample, body.flat(), {&light, 1}, {}).front().sight !=
                               LightSight::faces_away;
      lit_beyond += mask[i] == 255 && !flat_active;
      away += line.sight == LightSight::faces_away;
    }
  }
  EXPECT_GT(lit_beyond, 20u) << "light from beyond a triangle's plane";
  EXPECT_GT(away, 100u);
}

TEST(Sightlines, AnswerForManyLightsAndAnyThreads) {
  Random random(31);
  MaskCase c;
  c.soup = room(random, 3000);
  c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, 12, 12);
  c.points = view_samples(c.soup.view(), c.view, 12, 12);
  std::vector<ShadowLight> lights;
  for (int i = 0; i < 9; ++i)
    lights.push_back(i % 4 == 3 ? sun(random.direction()) : point_light(random.in_cube(1)));
  for (std::size_t i = 0; i < c.points.triangles.size(); i += 5) {
    Sample sample{c.points.positions[i], c.points.triangles[i]};
    if (sample.triangle == no_triangle) continue;
    sample.side = points::eye_side(points::corners_of(c.soup.view(), sample.triangle).v, c.view);
    std::vector<Sightline> together;
    with_threads(3, [&] { together = shadow::find_sightlines(sample, c.soup.view(), lights, c.config); });
    ASSERT_EQ(together.size(), lights.size());
    for (std::size_t k = 0; k < lights.size(); ++k) {
      Sightline alone;
      with_threads(1, [&] {
        alone = shadow::find_sightlines(sample, c.soup.view(), {&lights[k], 1}, c.config).front();
      });
      EXPECT_EQ(together[k].sight, alone.sight);
      EXPECT_EQ(together[k].first, alone.first);
      EXPECT_EQ(together[k].blockers, alone.blockers);
    }
  }
}

}  // namespace
}  // namespace tenebra::testing
