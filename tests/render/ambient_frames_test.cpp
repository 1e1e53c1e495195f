// Frames with ambient occlusion: it darkens the ambient term where geometry stands close, and nothing else.
#include "render/render_fixture.h"
#include "support/parameter_names.h"

namespace tenebra {
namespace {

using glm::vec3;

constexpr int floor_width = 81, floor_height = 61;

/// Floor, plate and a light, all with ambient light; the plate glows a little.
Scene corner_scene() {
  Scene scene = white_floor(true);
  scene.materials.push_back({.name = "glow", .base_color = vec3(0.0f), .emissive = vec3(0.25f)});
  scene.meshes[0].materials[2] = scene.meshes[0].materials[3] = 1;
  scene.ambient_light = vec3(0.4f);
  add_light(scene, {.name = "lamp", .falloff = Falloff::none, .intensity = 0.3f}, {3, 6, 2});
  return scene;
}

constexpr double reach = 2;

/// What hides a floor point from ambient light: the cosine-weighted mean of the fall-off over what rays meet.
struct Hidden {
  double share = 0;   ///< mean of 1 - r / reach, 0 beyond the plate and the reach
  double square = 0;  ///< mean of its square
};

/// By the plate of 2 x 2 one above the floor's middle: (1 - r / reach) cos^2 / (pi r^2) over its area, by the
/// midpoint rule (its error is below 1e-4: the integrand is smooth but for the bend at the reach).
Hidden hidden_by_plate(const glm::dvec3& p) {
  constexpr int steps = 64;
  constexpr double step = 2.0 / steps;
  Hidden hidden;
  for (int j = 0; j < steps; ++j) {
    for (int i = 0; i < steps; ++i) {
      const double x = -1 + (i + 0.5) * step - p.x, z = -1 + (j + 0.5) * step - p.z;
      const double r2 = 1 + x * x + z * z, left = std::max(0.0, 1 - std::sqrt(r2) / reach);
      const double weight = step * step / (3.141592653589793 * r2 * r2);
      hidden.share += weight * left, hidden.square += weight * left * left;
    }
  }
  return hidden;
}

render::RenderSettings occluded(AoMode mode) {
  render::RenderSettings settings{
      .width = floor_width, .height = floor_height, .shadows = render::ShadowMode::none};
  settings.ao.mode = mode;
  settings.ao.distance_m = reach;
  return settings;
}

class AmbientFrames : public ::testing::TestWithParam<AoMode> {};

// Rays spread evenly err by less than independent ones, whose mean has a standard deviation of
// sqrt((square - share^2) / rays): four of those, and a level for rounding twice (the mask, the picture).
TEST_P(AmbientFrames, DarkenTheFloorAroundThePlateByTheClosedForm) {
  Scene scene = corner_scene();
  scene.lights[0].intensity = 0;
  render::RenderSettings settings = occluded(GetParam());
  constexpr int rays = 256;  // as many as surface samples have
  settings.ao.rays = rays;
  const render::FrameResult result = draw(scene, settings);
  const ViewRays view = frame_of(scene, floor_width, floor_height).view;
  int in_the_open = 0, below = 0;
  double squares = 0, darkest = 0;
  for (int y = 0; y < floor_height; ++y) {
    for (int x = 0; x < floor_width; ++x) {
      const auto p = on_plane(view, x, y), plate = on_plane(view, x, y, 1);
      const double level = result.image.pixels[static_cast<std::size_t>(3 * (y * floor_width + x))];
      if (!p || std::max(std::abs(p->x), std::abs(p->z)) > 9.9) continue;
      const double across = plate ? std::max(std::abs(plate->x), std::abs(plate->z)) : 2;
      if (across < 0.99) {
        EXPECT_EQ(level, std::lround(srgb_level(0.25))) << "what glows is not occluded";
      }
      if (across < 1.01) continue;  // the plate or its edge
      const Hidden hidden = hidden_by_plate(*p);
      const double off = 4 * std::sqrt((hidden.square - hidden.share * hidden.share) / rays);
      const double expected = srgb_level(0.4 * (1 - hidden.share));
      EXPECT_LE(level, srgb_level(0.4 * (1 - hidden.share + off)) + 1) << p->x << " " << p->z;
      EXPECT_GE(level, srgb_level(0.4 * (1 - hidden.share - off)) - 1) << p->x << " " << p->z;
      if (hidden.share == 0) {
        ++in_the_open;
      } else if (std::max(std::abs(p->x), std::abs(p->z)) < 0.9) {
        squares += (level - expected) * (level - expected), ++below;
        darkest = std::max(darkest, srgb_level(0.4) - expected);
      }
    }
  }
  EXPECT_GT(in_the_open, 500);
  ASSERT_GT(below, 5);
  EXPECT_GT(darkest, 8);                       // else the bounds above would allow no darkening at all
  EXPECT_LT(std::sqrt(squares / below), 0.6);  // 0.29 by rounding to levels alone
  EXPECT_GT(result.ao.points, 0u);
  EXPECT_GT(result.timings.ao_build_ms + result.timings.ao_ms, 0);
}

TEST_P(AmbientFrames, LeaveDirectLightAlone) {
  Scene scene = corner_scene();
  scene.ambient_light = vec3(0.0f);
  const render::FrameResult without = draw(scene, occluded(AoMode::none)),
                            with = draw(scene, occluded(GetParam()));
  EXPECT_EQ(with.image, without.image);
  EXPECT_GT(*std::max_element(with.image.pixels.begin(), with.image.pixels.end()), 60);
}

TEST_P(AmbientFrames, StandBesideEveryShadowMode) {
  const Scene scene = corner_scene();
  render::RenderSettings settings = occluded(GetParam());
  settings.area_lights.size = {1, 1};
  for (const render::ShadowMode mode :
       {render::ShadowMode::none, render::ShadowMode::hard, render::ShadowMode::soft}) {
    settings.shadows = mode;
    render::RenderSettings bright = settings;
    bright.ao.mode = AoMode::none;
    const render::FrameResult with = draw(scene, settings), without = draw(scene, bright);
    int darker = 0;
    for (std::size_t i = 0; i < with.image.pixels.size(); ++i) {
      ASSERT_LE(with.image.pixels[i], without.image.pixels[i]);
      darker += with.image.pixels[i] < without.image.pixels[i];
    }
    EXPECT_GT(darker, 30);
    ASSERT_EQ(with.masks.size(), without.masks.size());
    for (std::size_t i = 0; i < with.masks.size(); ++i) {
      EXPECT_EQ(with.masks[i].mask, without.masks[i].mask);
    }
  }
}

TEST_P(AmbientFrames, GiveTheSameBitsForEveryThreadCount) {
  const Scene scene = corner_scene();
  render::RenderSettings settings = occluded(GetParam());
  const io::Image8 expected = draw(scene, settings).image;
  for (const int threads : {1, 2, 3}) {
    settings.threads = threads;
    EXPECT_EQ(draw(scene, settings).image, expected) << threads;
  }
}

TEST_P(AmbientFrames, StopWhenAskedTo) {
  const Scene scene = corner_scene();
  render::Renderer renderer = renderer_for(scene);
  StopFlag stop;
  stop.request();
  render::FrameResult result;
  const auto drawn = renderer.render_frame(frame_of(scene, floor_width, floor_height), occluded(GetParam()),
                                           result, {}, &stop);
  ASSERT_FALSE(drawn);
  EXPECT_TRUE(is_stop(drawn));
  EXPECT_TRUE(
      renderer.render_frame(frame_of(scene, floor_width, floor_height), occluded(GetParam()), result));
}

TEST(AmbientSettings, NeedExactPoints) {
  const Scene scene = corner_scene();
  render::RenderSettings settings = occluded(AoMode::rays);
  settings.samples = render::SampleSource::depth;
  render::Renderer renderer = renderer_for(scene);
  render::FrameResult result;
  const auto drawn = renderer.render_frame(frame_of(scene, floor_width, floor_height), settings, result);
  ASSERT_FALSE(drawn);
  EXPECT_EQ(drawn.error().message,
            "samples from the depth buffer: ambient occlusion needs the exact points from triangle ids");
}

INSTANTIATE_TEST_SUITE_P(, AmbientFrames, ::testing::Values(AoMode::field, AoMode::rays),
                         [](const auto& mode) { return mode.param == AoMode::field ? "field" : "rays"; });

}  // namespace
}  // namespace tenebra
