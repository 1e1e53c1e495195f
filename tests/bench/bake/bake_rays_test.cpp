// The contestant of `tenebra-bench bake`: its rays bring the light that there is.
#include <gtest/gtest.h>

#include <tenebra/queries.h>
#include "bench/bake/bake_rays.h"
#include "bench/soft/soft_quality.h"

namespace tenebra::bench {
namespace {

using glm::vec3;

/// A floor of 4 x 4 m, and a plate over a quarter of it.
FrameGeometry floor_and_plate() {
  FrameGeometry geometry;
  geometry.positions = {{-2, 0, 2},  {2, 0, 2},   {2, 0, -2},  {-2, 0, -2},
                        {0, 0.5, 1}, {1, 0.5, 1}, {1, 0.5, 0}, {0, 0.5, 0}};
  geometry.normals.resize(8);
  geometry.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  geometry.casts_shadow.assign(4, 1);
  return geometry;
}

std::vector<bake::Sample> samples_on_the_floor() {
  std::vector<bake::Sample> samples;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const double a = (i % 8 + 0.4) / 9, b = (i / 8 + 0.6) / 6 * (1 - a);
    samples.push_back({i, 0, 1.0f, {1 - a - b, a, b}});
  }
  return samples;
}

TEST(BakeRays, OpenLightIsThatOfTheDoubles) {
  const AreaLight light = make_rectangle_light({0.3f, 2, -0.2f}, {0.9f, 0, 0}, {0, 0, 0.7f}).value();
  ASSERT_LT(light.normal.y, 0);
  for (const vec3 normal : {vec3(0, 1, 0), vec3(0.8f, 0.6f, 0), vec3(0.9959f, 0.09f, 0), vec3(0, -1, 0)}) {
    for (const vec3 at : {vec3(0), vec3(-1.4f, 0.3f, 0.8f), vec3(0.5f, 1.9f, 0), vec3(0, 2.5f, 0)}) {
      const vec3 unit = glm::normalize(normal);
      const double expected =
          unoccluded(light, glm::dvec3(at), glm::dvec3(unit), glm::dvec3(unit)).irradiance;
      EXPECT_NEAR(static_cast<double>(open_irradiance(light, {at, unit, unit})), expected, 2e-5);
    }
  }
}

TEST(BakeRays, ManyRaysBringTheExactLight) {
  const FrameGeometry geometry = floor_and_plate();
  const AreaLight light = make_rectangle_light({0.3f, 2, 0.4f}, {0.5f, 0, 0}, {0, 0, 0.5f}).value();
  const auto samples = samples_on_the_floor();
  const auto receivers = texel_receivers(geometry, samples, 1e-6f);
  const EmbreeScene casters(triangle_view(geometry), true);

  std::vector<glm::dvec3> positions;
  for (const SampledReceiver& r : receivers) positions.emplace_back(r.position);
  const std::vector<std::uint32_t> on(samples.size(), 0);
  const std::vector<std::int8_t> sides(samples.size(), 1);
  std::vector<float> fraction(samples.size()), exact(samples.size());
  const auto kept = Geometry::create(geometry.positions, geometry.triangles, geometry.casts_shadow).value();
  PointTracer tracer;
  ASSERT_TRUE(tracer.soft_visibility(kept, {.positions = positions, .triangles = on, .sides = sides}, light,
                                     {}, fraction, exact));
  const auto parts = std::count_if(fraction.begin(), fraction.end(), [](float f) { return f > 0 && f < 1; });
  ASSERT_GT(parts, 3);

  for (const Packing packing : {Packing::pixel, Packing::tile}) {
    for (const RaySum sum : {RaySum::plain, RaySum::scaled}) {
      for (const auto& [rays, error] : {std::pair{4096, 0.004f}, std::pair{4, 0.15f}}) {
        std::vector<float> light_of(samples.size());
        BakeRays(light, static_cast<std::size_t>(rays), packing, sum).trace(casters, receivers, light_of);
        for (std::size_t i = 0; i < samples.size(); ++i)
          EXPECT_NEAR(light_of[i], exact[i], error) << packing_name(packing) << " " << ray_sum_name(sum);
      }
    }
  }
}

}  // namespace
}  // namespace tenebra::bench
