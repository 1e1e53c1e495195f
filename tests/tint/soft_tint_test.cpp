// Area lights through glass, against thousands of Embree's rays per point.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "parallel/parallel.h"
#include "soft/light/light_places.h"
#include "tint/glass_case.h"
#include "tint/soft_tint.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using glm::vec3;

AreaLight rectangle(vec3 centre, vec3 half_x, vec3 half_y) {
  auto light = make_rectangle_light(centre, half_x, half_y);
  EXPECT_TRUE(light.has_value());
  return *light;
}

Soup square(dvec3 corner, dvec3 u, dvec3 v) {
  Soup soup;
  soup.quad(corner, u, v);
  return soup;
}

const ViewRays above = pinhole({0.3, 6, 5}, {0, 0, 0}, 0.4, 24, 24);
const AreaLight ceiling = rectangle({0.1f, 5, -0.2f}, {1, 0, 0}, {0, 0, 1});  // shines down

struct SoftAnswers {
  SoftMask mask;
  TintMask tint;
  TintStats stats;
};

SoftAnswers traced(const Glass& glass, const VisiblePoints& points, const AreaLight& light,
                   const TintConfig& config = {}, const ViewRays& view = above) {
  SoftAnswers a;
  SoftShadowConfig soft;
  soft.simd = config.simd;
  SoftShadowTracer shadows;
  EXPECT_TRUE(shadows.trace(seen_from(points, view), {}, glass.soup.view(), light, soft, a.mask));
  TintTracer tracer;
  EXPECT_TRUE(tracer.trace(seen_from(points, view), {}, glass.soup.view(), glass.surfaces(), light, a.mask,
                           config, a.tint));
  a.stats = tracer.stats();
  return a;
}

/// Irradiance by side x side rays to places of the light, a rectangle or a sun, one in the middle of a turned
/// lattice's cell each.
dvec3 by_rays(GlassPeer& peer, const AreaLight& light, const dvec3& p, const dvec3& normal, std::uint32_t own,
              int side) {
  const soft::LightPlaces places(light);
  dvec3 sum(0.0);
  for (int i = 0; i < side * side; ++i) {
    const double x = i * 0.41421356237309515 + 0.3, y = i * 0.7320508075688772 + 0.1;
    const double a = (i % side + x - std::floor(x)) / side, b = (i / side + y - std::floor(y)) / side;
    const dvec3 place(places.at(a, b)), way = light.at_infinity ? place : place - p;
    const double square = glm::dot(way, way);
    const double weight = std::max(0.0, glm::dot(normal, way)) * std::max(0.0, -glm::dot(light.normal, way)) /
                          (square * square);
    if (weight > 0) sum += weight * peer.passed(p, light.at_infinity ? 50.0 * way : way, own);
  }
  return sum * places.area() / static_cast<double>(side * side);
}

/// Every `every`-th pixel within `bound` of the brightest.
void compare(const Glass& glass, const AreaLight& light, double bound, bool numeric, int every = 1) {
  const VisiblePoints points = glass.samples(above, 24, 24);
  const SoftAnswers a = traced(glass, points, light);
  EXPECT_GT(a.tint.pixels.size(), 60u);
  EXPECT_EQ(a.stats.numeric > 0, numeric);
  const std::vector<vec3> factors = spread(a.tint, points.triangles.size());
  const double white = *std::max_element(a.mask.irradiance.begin(), a.mask.irradiance.end());
  GlassPeer peer(glass);
  double worst = 0;
  for (std::size_t i = 0; i < points.triangles.size(); i += static_cast<std::size_t>(every)) {
    if (points.triangles[i] == no_triangle || !(a.mask.irradiance[i] > 0)) continue;
    const glm::uvec3 t = glass.soup.triangles[points.triangles[i]];
    dvec3 n = glm::normalize(glm::cross(dvec3(glass.soup.positions[t.y]) - dvec3(glass.soup.positions[t.x]),
                                        dvec3(glass.soup.positions[t.z]) - dvec3(glass.soup.positions[t.x])));
    if (glm::dot(n, dvec3(above.eye) - points.positions[i]) < 0) n = -n;
    const dvec3 expected = by_rays(peer, light, points.positions[i], n, points.triangles[i], 96);
    const dvec3 found = static_cast<double>(a.mask.irradiance[i]) * dvec3(factors[i]);
    const dvec3 off = glm::abs(found - expected) / white;
    if (std::max({off.x, off.y, off.z}) > bound) {
      ADD_FAILURE() << "pixel " << i << " at " << points.positions[i].x << ' ' << points.positions[i].z
                    << ": irradiance " << a.mask.irradiance[i] << " of " << white << ", found " << found.x
                    << ' ' << found.y << ' ' << found.z << ", expected " << expected.x << ' ' << expected.y
                    << ' ' << expected.z;
    }
    worst = std::max({worst, off.x, off.y, off.z});
  }
  std::printf("worst: %.3f / 255 of white; %zu points, %llu by places\n", 255 * worst, a.tint.pixels.size(),
              static_cast<unsigned long long>(a.stats.numeric));
  EXPECT_LE(worst, bound);
}

Glass room_with_panes() {
  Glass glass;
  glass.add(square({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), Material{});
  glass.add(box({-0.6, 0, -0.5}, {0.3, 0.8, 0.5}), Material{});
  glass.add(box({0.5, 1.2, -0.4}, {1.0, 1.6, 0.4}), Material{});
  glass.add(square({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), pane({0.9f, 0.3f, 0.2f}, 0.8f));
  glass.add(square({-0.5, 1.7, 1.5}, {2, 0, 0}, {0, 0.2, -2}), pane({0.1f, 0.8f, 0.9f}, 1.0f));
  glass.add(square({-1.5, 2, 0.5}, {2, 0.3, 0}, {0, 0, -2}), blend(0.4f));
  return glass;
}

TEST(SoftTint, PanesAreWithinHalfAStepOfRays) {
  compare(room_with_panes(), ceiling, 0.5 / 255, false);
}

TEST(SoftTint, SunsToo) {
  const auto sun = make_sun({0.2f, 1, 0.3f}, 8);
  ASSERT_TRUE(sun.has_value());
  compare(room_with_panes(), *sun, 0.5 / 255, false);
}

TEST(SoftTint, SmallLightsToo) {
  compare(room_with_panes(), rectangle({0.5f, 4, 0.4f}, {0.15f, 0, 0}, {0, 0, 0.15f}), 0.5 / 255, false);
}

TEST(SoftTint, TexturedPanesAreWithinHalfAStepOfRays) {
  Glass glass = room_with_panes();
  glass.scene.images.push_back(waves(32));
  Material leaf = blend(0.9f);
  leaf.base_color_map.image = 0;
  glass.add(square({-1.5, 2.5, 1}, {2.5, 0, 0}, {0, 0, -2}), leaf,
            [](vec3 p) { return glm::vec2(0.7f * p.x, 0.9f * p.z); });
  compare(glass, ceiling, 0.5 / 255, true);
}

TEST(SoftTint, GlassOfManyTrianglesIsWithinHalfAStepOfRays) {
  Glass glass = room_with_panes();
  glass.add(sphere(6, 0.6, {-0.8, 1.6, 0.6}), pane({0.6f, 0.9f, 0.7f}, 0.8f));
  compare(glass, ceiling, 0.5 / 255, true, 2);
}

TEST(SoftTint, APaneBeforeAllOfTheLightIsItsTransmittance) {
  Glass glass;
  glass.add(square({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), Material{});
  glass.add(square({-9, 2, 9}, {18, 0, 0}, {0, 0, -18}), pane({0.5f, 0.25f, 0.75f}, 1));
  const VisiblePoints points = glass.samples(above, 24, 24);
  const SoftAnswers a = traced(glass, points, ceiling);
  std::size_t seen = 0;
  for (const float irradiance : a.mask.irradiance) seen += irradiance > 0;
  EXPECT_EQ(a.tint.pixels.size(), seen);
  for (const vec3& f : a.tint.factors) {
    EXPECT_NEAR(f.x, 0.5, 1e-4);
    EXPECT_NEAR(f.y, 0.25, 1e-4);
    EXPECT_NEAR(f.z, 0.75, 1e-4);
  }
}

TEST(SoftTint, APaneOfManyTrianglesIsItsTransmittance) {
  constexpr int side = 240;
  constexpr double step = 1.4 / side;
  Glass glass;
  glass.add(square({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), Material{});
  Soup fine;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      fine.quad({-0.6 + step * column, 2, 0.5 - step * row}, {step, 0, 0}, {0, 0, -step});
  glass.add(fine, pane({0.5f, 0.25f, 0.75f}, 1));
  const ViewRays near = pinhole({0.1, 6, 5}, {0.1, 0, -0.2}, 0.03, 4, 4);
  const VisiblePoints points = glass.samples(near, 4, 4);
  const SoftAnswers a = traced(glass, points, ceiling, {}, near);
  ASSERT_EQ(a.tint.pixels.size(), 16u);
  EXPECT_GT(a.stats.tests / 16, tint::most_set_up) << "shadows on the light at each point";
  for (const vec3& f : a.tint.factors) {
    EXPECT_NEAR(f.x, 0.5, 1e-3);
    EXPECT_NEAR(f.y, 0.25, 1e-3);
    EXPECT_NEAR(f.z, 0.75, 1e-3);
  }
}

TEST(SoftTint, NeitherThreadsNorLevelsChangeABit) {
  Glass glass = room_with_panes();
  glass.add(sphere(4, 0.6, {-0.8, 1.6, 0.6}), pane({0.6f, 0.9f, 0.7f}, 0.8f));
  const VisiblePoints points = glass.samples(above, 24, 24);
  for (const double error : {0.0, 3.0, 30.0}) {
    TintConfig config;
    config.error_255 = error;
    const auto found = [&] {
      return spread(traced(glass, points, ceiling, config).tint, points.triangles.size());
    };
    const std::vector<vec3> expected = found();
    for (const int threads : {1, 2, 5})
      with_threads(threads, [&] { EXPECT_EQ(found(), expected) << threads; });
    for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      config.simd = level;
      EXPECT_EQ(found(), expected) << simd_level_name(level);
    }
  }
}

/// RMS over the points that a tint is for, in 1/255 of white.
double rms_between(const SoftAnswers& a, const TintMask& other, std::size_t points) {
  const std::vector<vec3> x = spread(a.tint, points), y = spread(other, points);
  const double white = *std::max_element(a.mask.irradiance.begin(), a.mask.irradiance.end());
  double sum = 0;
  for (const std::uint32_t i : a.tint.pixels) {
    const dvec3 off = static_cast<double>(a.mask.irradiance[i]) / white * dvec3(x[i] - y[i]);
    sum += glm::dot(off, off) / 3;
  }
  return 255 * std::sqrt(sum / static_cast<double>(a.tint.pixels.size()));
}

TEST(SoftTint, AnAllowedErrorTakesFewerPlaces) {
  for (const auto& [error, side] :
       {std::pair(0.0, 64), {0.5, 64}, {1.0, 64}, {2.0, 32}, {4.0, 16}, {8.0, 16}, {12.0, 8}, {255.0, 8}})
    EXPECT_EQ(tint::grid_side_for(error), side) << error;
}

TEST(SoftTint, FewerPlacesAreWithinHalfOfTheAllowedError) {
  for (const float passes : {0.0f, 0.5f}) {  // black panes, whose edges matter most, and grey ones
    for (const float half : {0.3f, 1.0f, 2.0f}) {
      Glass glass;
      glass.add(square({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), Material{});
      glass.add(sphere(12, 0.6, {-0.8, 1.6, 0.6}), pane(vec3(passes), 1));
      glass.add(sphere(8, 0.4, {0.9, 2.4, -0.3}), pane(vec3(passes), 1));
      const AreaLight light = rectangle({0.1f, 5, -0.2f}, {half, 0, 0}, {0, 0, half});
      const ViewRays fine = pinhole({0.3, 6, 5}, {0, 0, 0}, 0.4, 48, 48);
      const VisiblePoints points = glass.samples(fine, 48, 48);
      const SoftAnswers exact = traced(glass, points, light, {}, fine);
      ASSERT_GT(exact.stats.numeric, 200u);
      for (const double error : {2.0, 4.0, 12.0}) {
        TintConfig config;
        config.error_255 = error;
        const double found =
            rms_between(exact, traced(glass, points, light, config, fine).tint, points.triangles.size());
        EXPECT_GT(found, 0);
        EXPECT_LT(found, 0.5 * error) << "passes " << passes << ", light of half side " << half;
        std::printf("passes %.1f, half side %.1f, error %4.1f: %.2f/255\n", double(passes), double(half),
                    error, found);
      }
    }
  }
}

TEST(SoftTint, OrderChangesNoMoreThanRounding) {
  Glass glass = room_with_panes();
  const VisiblePoints points = glass.samples(above, 24, 24);
  const std::vector<vec3> expected = spread(traced(glass, points, ceiling).tint, points.triangles.size());
  Glass other = glass;
  std::reverse(other.soup.triangles.end() - 6, other.soup.triangles.end());
  std::reverse(other.materials.end() - 6, other.materials.end());
  const std::vector<vec3> found = spread(traced(other, points, ceiling).tint, points.triangles.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i][c], expected[i][c], 1e-4);
}

TEST(SoftTint, AnEstimatedMaskIsNotNeeded) {
  const Glass glass = room_with_panes();
  const VisiblePoints points = glass.samples(above, 24, 24);
  const SoftAnswers a = traced(glass, points, ceiling);
  TintConfig config;
  config.own_irradiance = true;
  TintMask own;
  TintTracer tracer;
  SoftMask rough = a.mask;
  for (float& irradiance : rough.irradiance) irradiance *= 0.7f;
  ASSERT_TRUE(tracer.trace(seen_from(points, above), {}, glass.soup.view(), glass.surfaces(), ceiling, rough,
                           config, own));
  const std::vector<vec3> x = spread(own, points.triangles.size()),
                          y = spread(a.tint, points.triangles.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(x[i][c], y[i][c], 0.002);
}

}  // namespace
}  // namespace tenebra::testing
