// Soft shadows with an error that was asked for: it is that of the light that the picture shows.
#include <gtest/gtest.h>

#include <cmath>

#include "soft/leaves.h"

namespace tenebra::testing {
namespace {

// Lights of BART have no fall-off: what is far from them counts as much as what is near (seed 96: told 0.8
// where 5.9 were off).
TEST(ShownLight, IsWhatErrorsAreOf) {
  const SoftCase c = below_leaves(112);
  std::vector<float> shown(c.size());
  for (std::size_t i = 0; i < c.size(); ++i) {
    const glm::dvec3 path = c.light.centre - c.points.positions[i];
    const double distance = glm::length(path), height = glm::dot(c.light.normal, -path);
    if (height > 0) shown[i] = static_cast<float>(std::pow(distance, 3) / height);
  }
  const auto in_picture = [&](SoftMask mask) {
    for (std::size_t i = 0; i < c.size(); ++i) mask.irradiance[i] *= shown[i];
    return mask;
  };
  const SoftMask exact = in_picture(traced(c, SoftShadowConfig{}));
  for (const double asked : {8.0, 4.0}) {
    SoftShadowTracer tracer;
    SoftMask mask;
    ASSERT_TRUE(tracer.trace(seen_from(c.points, c.view), c.normals, c.soup.view(), c.light,
                             {.error_255 = asked}, mask, nullptr, shown));
    const double error = error_of(c, in_picture(mask), exact);
    EXPECT_LE(error, 1.3 * asked);
    EXPECT_LE(error, 1.5 * tracer.stats().error_255) << asked;
    EXPECT_LE(tracer.stats().error_255, 1.5 * error) << asked;
  }
}

TEST(ShownLight, HasAnyUnit) {
  const SoftCase c = below_leaves(48);
  const SoftMask expected = traced(c, {.error_255 = 2});
  SoftShadowTracer tracer;
  SoftMask mask;
  ASSERT_TRUE(tracer.trace(seen_from(c.points, c.view), c.normals, c.soup.view(), c.light, {.error_255 = 2},
                           mask, nullptr, std::vector<float>(c.size(), 0.25f)));
  EXPECT_EQ(mask.irradiance, expected.irradiance);
}

}  // namespace
}  // namespace tenebra::testing
