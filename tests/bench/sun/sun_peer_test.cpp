// The contestant of `tenebra-bench sun`: its rays count the suns that there are, in each of its orders.
#include "bench/sun/sun_peer.h"

#include <gtest/gtest.h>

#include "bench/sun/sun_models.h"
#include "sun/sun_hours.h"

namespace tenebra::bench {
namespace {

TEST(SunPeer, CountsWhatTenebraCountsInEachOrder) {
  const Scene scene = houses_scene(2, 2);
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  const auto receivers = sun::face_receivers(scene, frame, {.per_face = 9}).value();
  const sun::Suns suns = suns_of_day(60);
  const auto geometry = Geometry::create(frame.positions, frame.triangles).value();
  const auto ours = sun::sun_hours(geometry, receivers, suns, {}).value().sums;
  const TriangleView triangles = triangle_view(frame);
  const EmbreeScene casters(triangles, true, true);
  ASSERT_FALSE(sun_plans(casters).empty());
  for (const SunPlan& plan : sun_plans(casters)) {
    SCOPED_TRACE(sun_plan_name(plan));
    const PeerPlaces places = peer_places(receivers, triangles, plan.sorted, 1e-4f);
    const auto theirs = peer_sums(casters, places, receivers.list.size(), suns.list, plan);
    ASSERT_EQ(theirs.size(), ours.size());
    for (std::size_t r = 0; r < ours.size(); ++r) EXPECT_NEAR(theirs[r], ours[r], 1e-9) << "face " << r;
  }
}

TEST(SunModels, StandAsTheySay) {
  const Scene houses = houses_scene(3, 2);
  EXPECT_EQ(houses.meshes[0].triangles.size(), 3u * 2 * 14);
  EXPECT_EQ(houses.meshes[1].triangles.size(), 3u * 2 * 2);
  const Scene terrain = terrain_scene(8, 2);
  EXPECT_EQ(terrain.meshes[0].triangles.size(), 2u * (64 - 4));
  EXPECT_EQ(terrain.meshes[1].triangles.size(), 2u * 4);
  EXPECT_GT(suns_of_day(10).list.size(), 90u);  // of sixteen hours
}

}  // namespace
}  // namespace tenebra::bench
