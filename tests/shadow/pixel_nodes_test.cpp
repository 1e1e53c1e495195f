// Node tests a pixel: what the viewer's heat map shows.
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
    const auto with_nodes = static_cast<std::uint64_t>(std::count_if(nodes.begin(), nodes.end(), [](auto n) { return n > 0; }));
    EXPECT_EQ(with_nodes, stats.rays) << "every ray is below the root, which every triangle is tested with";
    const std::uint64_t sum = std::accumulate(nodes.begin(), nodes.end(), std::uint64_t{0});
    EXPECT_GE(sum, stats.nodes) << "a node that is tested has a ray";
    EXPECT_LE(*std::max_element(nodes.begin(), nodes.end()), stats.nodes);
  }
}

TEST(PixelNodes, OfOnePacketAreAllNodeTests) {
  for (const Variant variant : all_variants) {
    MaskCase c = sphere_over_floor(4, 4);
    c.config.variant = variant;
    c.config.count_pixel_nodes = true;
    ShadowTracer tracer;
    traced(c, tracer);
    ASSERT_GT(tracer.stats().rays, 0u);
    for (const std::uint32_t nodes : tracer.pixel_nodes()) {
      if (nodes > 0) EXPECT_EQ(nodes, tracer.stats().nodes) << variant_name(variant);
    }
  }
}

TEST(PixelNodes, DoNotDependOnThreads) {
  MaskCase c = sphere_over_floor(200, 150);
  c.config.count_pixel_nodes = true;
  std::vector<std::uint32_t> alone;
  ShadowTracer tracer;
  with_threads(1, [&] { traced(c, tracer); });
  alone.assign(tracer.pixel_nodes().begin(), tracer.pixel_nodes().end());
  with_threads(4, [&] { traced(c, tracer); });
  EXPECT_TRUE(std::equal(alone.begin(), alone.end(), tracer.pixel_nodes().begin(), tracer.pixel_nodes().end()));
}

}  // namespace
}  // namespace tenebra::testing
