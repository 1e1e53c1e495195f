// What see-through surfaces hide of the ambient light.
#include <gtest/gtest.h>

#include "ao/ao_case.h"

namespace tenebra::testing {
namespace {

constexpr std::size_t ground_triangles = 2;

/// A pane over a floor, standing or moving, of a material that lets `transmission` pass.
Scene pane_over_floor(float transmission, bool moves) {
  SceneMaker make;
  make.add(quad_mesh({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}));
  Material glass;
  glass.transmission = transmission;
  make.scene.materials.push_back(glass);
  Mesh pane = quad_mesh({-1, 0.5f, -1}, {0, 0, 2}, {2, 0, 0});
  pane.materials = {1, 1};
  const int node = make.add(pane);
  if (moves) make.move(node, {0.2, 0, 0});
  return make.scene;
}

std::vector<float> openness(const Scene& scene, AoMode mode, VisiblePoints* points = nullptr) {
  const ViewRays view = pinhole({0, 0.4, 4}, {0, 0.1, 0}, 0.4, 64, 48);  // below the pane
  const AoView frame(scene, 0, view, 64, 48);
  if (points != nullptr) *points = frame.points;
  AoConfig config;
  config.mode = mode;
  config.rays = 64;
  config.distance_m = 2;
  return occlude(scene, frame, config);
}

// What is see-through is found by the same rays in both modes, and they are those of the mode `rays`, where
// an opaque pane's hits are Embree's: two intersections of the same float ray with the same triangle. A
// distance of at most 2 m is off by a few roundings of 2^-23 m in each, so each ray's share by less than
// 1e-6, and so their mean; times (1 - T) it is rounded twice more. A ray that only one of them lets pass at
// the pane's edge would be off by up to 1/128, and there is none here.
TEST(SeeThroughOcclusion, APaneHidesWhatAnOpaqueOneHidesTimesItsOpacity) {
  for (const bool moves : {false, true}) {
    VisiblePoints points;
    const auto opaque = openness(pane_over_floor(0, moves), AoMode::rays, &points);
    for (const AoMode mode : {AoMode::rays, AoMode::field}) {
      const auto half = openness(pane_over_floor(0.5f, moves), mode);
      const auto clear = openness(pane_over_floor(1, moves), mode);
      std::size_t hidden = 0;
      for (std::size_t i = 0; i < opaque.size(); ++i) {
        if (points.triangles[i] >= ground_triangles) continue;
        hidden += opaque[i] < 0.8f;
        ASSERT_NEAR(half[i], 1 - 0.5f * (1 - opaque[i]), 2e-6f) << i << ", moves " << moves;
        ASSERT_EQ(clear[i], 1.0f) << i;
      }
      EXPECT_EQ(hidden, 125u);  // of the floor's pixels, as many in both modes: they are the rays' own
    }
  }
}

TEST(SeeThroughOcclusion, TheMeanOfATextureCounts) {
  Scene scene = pane_over_floor(1, false);
  scene.images.push_back({"half", 2, 1, {255, 255, 255, 255, 0, 255, 255, 255}});  // red: the mean is a half
  scene.materials[1].transmission_map.image = 0;
  const auto textured = openness(scene, AoMode::rays);
  const auto half = openness(pane_over_floor(0.5f, false), AoMode::rays);
  EXPECT_EQ(textured, half);
}

}  // namespace
}  // namespace tenebra::testing
