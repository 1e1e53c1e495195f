// The oracle of the soft shadows on soups: rationals against long doubles, its culling, and rays of the
// oracle of the hard shadows.
#include <gtest/gtest.h>

#include <cmath>

#include "oracle/exact_mask.h"
#include "oracle/exact_soft.h"
#include "soft/random_place.h"
#include "support/samples.h"
#include "support/scaled.h"
#include "support/soup.h"

namespace tenebra::testing {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;
using oracle::ExactSoft;
using oracle::SoftAnswer;
using oracle::SweepNumbers;

/// A soup, a polygonal light above or beside it, and points on the soup's triangles.
struct SoupCase {
  Soup soup;
  AreaLight light;
  ViewRays view;
  VisiblePoints points;
  SoupCase(Random& random, const SoupMaker& maker, int count) : soup(maker.make(random)) {
    for (;;) {
      const auto [x, y, centre] = random_place(random, soup);
      auto made = random.chance(0.5) ? make_rectangle_light(centre, vec3(x), vec3(y))
                                     : make_disc_light(centre, vec3(x), vec3(y));
      if (made) {
        light = *made;
        break;
      }
    }
    view.eye = vec3(light.centre);
    points = points_on_triangles(soup, random, count);
  }
};

TEST(SoftOracle, RationalsAndLongDoublesAgree) {
  Random random(3);
  int compared = 0, partly = 0;
  std::size_t most = 0;
  for (const SoupMaker& maker : soup_makers()) {
    const SoupCase c(random, maker, 16);
    const ExactSoft oracle(c.view, c.soup.view(), c.light);
    for (std::size_t i = 0; i < c.points.positions.size(); ++i) {
      const dvec3 p = c.points.positions[i];
      const std::uint32_t id = c.points.triangles[i];
      const SoftAnswer rounded = oracle.answer(p, id);
      if (rounded.occluders > 16) continue;
      const SoftAnswer exact = oracle.answer(p, id, vec3(0), SweepNumbers::rational);
      EXPECT_NEAR(exact.visible_fraction, rounded.visible_fraction, rounded.error_bound)
          << maker.name << " " << i;
      EXPECT_NEAR(exact.irradiance, rounded.irradiance, 1e-12) << maker.name << " " << i;
      ++compared;
      partly += exact.visible_fraction > 0 && exact.visible_fraction < 1;
      most = std::max(most, rounded.occluders);
    }
  }
  std::printf("rationals against long doubles: %d points, %d of them in a penumbra, up to %zu occluders\n",
              compared, partly, most);
  EXPECT_GT(partly, 20);
}

/// By more than rounding.
bool inside_outline(const AreaLight& light, dvec2 p) {
  for (std::size_t k = 0; k < light.polygon.size(); ++k) {
    const dvec2 a = light.polygon[k], e = light.polygon[(k + 1) % light.polygon.size()] - a;
    if (!(e.x * (p.y - a.y) - e.y * (p.x - a.x) > 1e-9 * light.area_m2)) return false;
  }
  return true;
}

TEST(SoftOracle, TheCullingLosesNothing) {
  Random random(4);
  int kept = 0, all = 0;
  for (const SoupMaker& maker : soup_makers()) {
    const SoupCase c(random, maker, 6);
    const ExactSoft oracle(c.view, c.soup.view(), c.light);
    for (std::size_t i = 0; i < c.points.positions.size(); ++i) {
      const std::uint32_t id = c.points.triangles[i];
      const std::vector<std::uint32_t> near = oracle.candidates(c.points.positions[i], id);
      for (std::uint32_t t = 0; t < c.soup.triangles.size() && id != no_triangle; ++t) {
        ++all;
        if (std::find(near.begin(), near.end(), t) != near.end()) {
          ++kept;
          continue;
        }
        // A culled triangle hides nothing: no ray through a corner or its centre goes on to the light.
        const dvec3 q[3] = {dvec3(c.soup.corner(t, 0)), dvec3(c.soup.corner(t, 1)),
                            dvec3(c.soup.corner(t, 2))};
        for (const dvec3& x : {q[0], q[1], q[2], (q[0] + q[1] + q[2]) / 3.0}) {
          const dvec3 p = c.points.positions[i], d = x - p;
          const double slope = glm::dot(c.light.normal, d);
          const double where = glm::dot(c.light.normal, c.light.centre - p) / slope;
          if (!(slope < 0) || !(where > 1 + 1e-9)) continue;
          const dvec3 hit = p + where * d - c.light.centre;
          const dvec2 uv(glm::dot(hit, c.light.ex), glm::dot(hit, c.light.ey));
          const bool inside = glm::dot(c.light.normal, p - c.light.centre) > 0 && inside_outline(c.light, uv);
          EXPECT_FALSE(inside && t != id) << maker.name << " point " << i << " triangle " << t;
        }
      }
    }
  }
  std::printf("culling: %d of %d pairs kept\n", kept, all);
  EXPECT_LT(kept, all / 2);
}

/// Whether the visible region holds (u, v).
bool sees(const SoftAnswer& answer, dvec2 p) {
  return std::any_of(answer.visible.begin(), answer.visible.end(), [&](const oracle::Trapezoid& t) {
    const long double s = (p.x - t.left) / (t.right - t.left);
    return s >= 0 && s <= 1 && p.y >= t.low_left + s * (t.low_right - t.low_left) &&
           p.y <= t.high_left + s * (t.high_right - t.high_left);
  });
}

dvec2 random_point_of(const std::vector<dvec2>& outline, Random& random) {
  const std::size_t k = 1 + random.index(static_cast<std::uint32_t>(outline.size() - 2));
  double s = random.unit(), t = random.unit();
  if (s + t > 1) s = 1 - s, t = 1 - t;
  return outline[0] + s * (outline[k] - outline[0]) + t * (outline[k + 1] - outline[0]);
}

struct RayCount {
  int rays = 0, free = 0, close = 0, wrong = 0;
};

/// Shadow rays to random points of the light by the oracle of the hard shadows. Each must agree with the
/// visible region, unless its end, rounded to float and so beside the light's plane, lies that close to the
/// region's border.
RayCount compare_with_rays(const SoupCase& c, Random& random, int ends) {
  RayCount count;
  const ExactSoft oracle(c.view, c.soup.view(), c.light);
  std::vector<SoftAnswer> answers;
  for (std::size_t i = 0; i < c.points.positions.size(); ++i)
    answers.push_back(oracle.answer(c.points.positions[i], c.points.triangles[i]));
  for (int k = 0; k < ends; ++k) {
    const dvec2 aimed = random_point_of(c.light.polygon, random);
    ShadowLight end;
    end.position = vec3(c.light.centre + aimed.x * c.light.ex + aimed.y * c.light.ey);
    const dvec3 offset = dvec3(end.position) - c.light.centre;
    const dvec2 uv(glm::dot(offset, c.light.ex), glm::dot(offset, c.light.ey));
    const double off = std::abs(glm::dot(offset, c.light.normal)) + 1e-12 * glm::length(offset);
    const oracle::ExactShadow hard(c.view, c.soup.view(), end, {});
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const dvec3 p = c.points.positions[i];
      const std::uint32_t id = c.points.triangles[i];
      const double height = glm::dot(c.light.normal, p - c.light.centre);
      if (id == no_triangle || !(height > 0)) continue;
      oracle::ExactMaskStats stats;
      const bool free = hard.active(p, id) && hard.blocker(p, id, stats) == no_triangle;
      ++count.rays, count.free += free;
      if (free == sees(answers[i], uv)) continue;
      // Where the ray meets the light's plane.
      const double shift = 4 * off * (1 + glm::length(dvec3(end.position) - p) / height);
      bool close = false;
      for (int n = 0; n < 9; ++n)
        close = close || sees(answers[i], uv + shift * dvec2(n % 3 - 1, n / 3 - 1)) == free;
      count.close += close, count.wrong += !close;
      EXPECT_TRUE(close) << "point " << i << ", end " << k << ": ray " << free << ", region " << !free;
    }
  }
  return count;
}

TEST(SoftOracle, ShadowRaysOfTheHardOracleAgreePointByPoint) {
  Random random(5);
  RayCount sum;
  for (const SoupMaker& maker : soup_makers()) {
    const SoupCase c(random, maker, 64);
    const RayCount count = compare_with_rays(c, random, scaled(16));
    EXPECT_EQ(count.wrong, 0) << maker.name;
    sum.rays += count.rays, sum.free += count.free, sum.close += count.close;
  }
  std::printf("hard rays: %d, %d of them free, %d closer to a border than the rounding of their ends\n",
              sum.rays, sum.free, sum.close);
  EXPECT_GT(sum.rays, scaled(6000));
  EXPECT_GT(sum.free, sum.rays / 20);
  EXPECT_LT(sum.close, sum.rays / 100);
}

}  // namespace
}  // namespace tenebra::testing
