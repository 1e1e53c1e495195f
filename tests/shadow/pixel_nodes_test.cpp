// Node tests per pixel: what the viewer's heat map shows.
#include <algorithm>
#include <numeric>

#include "shadow/mask_case.h"

namespace tenebra::testing {
namespace {

MaskCase sphere_over_floor(int width, int height) {
  MaskCase c;
  c.soup.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  c.soup.append(sphere(6, 1, {0, 1.5, 0}));
  c.view = pinhole({0, 4, 7}, {0, 0.5, 0}, 0.5, width, height);
  c.points = view_samples(c.soup.view(), c.view, width, height);
  c.light.position = {1, 6, 1};
  return c;
}

TEST(PixelNodes, ChangeNothingAndStandWhereRaysAre) {
  for (const Variant variant : all_variants) {
    MaskCase c = sphere_over_floor(80, 60);
    c.config.variant = variant;
    ShadowTracer tracer;
    const ShadowMask plain = traced(c, tracer);
    const TraceStats stats = tracer.stats();
    EXPECT_TRUE(tracer.pixel_nodes().empty()) << "not asked for";
    c.config.count_pixel_nodes = true;
    EXPECT_EQ(traced(c, tracer), plain) << variant_name(variant);
    EXPECT_EQ(tracer.stats().nodes, stats.nodes) << variant_name(variant);

    const auto nodes = tracer.pixel_nodes();
    ASSERT_EQ(nodes.size(), plain.size());
    const auto with_nodes =
        static_cast<std::uint64_t>(std::count_if(nodes.begin(), nodes.end(), [](auto n) { return n > 0; }));
    EXPECT_EQ(with_nodes, stats.rays) << "every ray is below the root, which every triangle is tested with";
    const double sum = std::accumulate(nodes.begin(), nodes.end(), 0.0);
    EXPECT_NEAR(sum, static_cast<double>(stats.nodes), 1e-5 * static_cast<double>(stats.nodes))
        << "all work, once";
    // A flat floor far from the sphere's shadow costs less than its edge.
    EXPECT_GT(*std::max_element(nodes.begin(), nodes.end()),
              1.5f * static_cast<float>(stats.nodes) / static_cast<float>(stats.rays));
  }
}

TEST(PixelNodes, OfOnePacketAreEqualShares) {
  for (const Variant variant : all_variants) {
    MaskCase c = sphere_over_floor(4, 4);
    c.config.variant = variant;
    c.config.count_pixel_nodes = true;
    ShadowTracer tracer;
    traced(c, tracer);
    ASSERT_GT(tracer.stats().rays, 0u);
    const float share = static_cast<float>(static_cast<double>(tracer.stats().nodes) /
                                           static_cast<double>(tracer.stats().rays));
    for (const float nodes : tracer.pixel_nodes()) {
      if (nodes > 0) {
        EXPECT_FLOAT_EQ(nodes, share) << variant_name(variant);
      }
    }
  }
}

TEST(PixelNodes, DoNotDependOnThreads) {
  MaskCase c = sphere_over_floor(200, 150);
  c.config.count_pixel_nodes = true;
  std::vector<float> alone;
  ShadowTracer tracer;
  with_threads(1, [&] { traced(c, tracer); });
  alone.assign(tracer.pixel_nodes().begin(), tracer.pixel_nodes().end());
  with_threads(4, [&] { traced(c, tracer); });
  EXPECT_TRUE(
      std::equal(alone.begin(), alone.end(), tracer.pixel_nodes().begin(), tracer.pixel_nodes().end()));
}

}  // namespace
}  // namespace tenebra::testing
