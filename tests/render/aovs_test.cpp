// AOVs of a frame, each against the geometry of a floor below a plate and a lamp.
#include "render/render_fixture.h"

namespace tenebra {
namespace {

constexpr int aov_width = 80, aov_height = 60;
constexpr float lamp_intensity = 0.5f;
const glm::vec3 lamp_place(0, 5, 0);

Scene lit_floor() {
  Scene scene = white_floor(true);
  scene.materials[0].base_color = {0.2f, 0.5f, 0.8f};
  add_light(scene,
            {.name = "lamp", .type = LightType::point, .falloff = Falloff::none, .intensity = lamp_intensity},
            lamp_place);
  return scene;
}

render::RenderSettings everything() {
  return {.width = aov_width,
          .height = aov_height,
          .aovs = {.depth = true,
                   .ids = true,
                   .normal = true,
                   .visibility = true,
                   .irradiance = true,
                   .openness = true,
                   .albedo = true}};
}

TEST(Aovs, AreEmptyUnlessAskedForAndLeaveThePictureAlone) {
  const Scene scene = lit_floor();
  const render::FrameResult plain = draw(scene, {.width = aov_width, .height = aov_height});
  EXPECT_TRUE(plain.aovs.depth.pixels.empty() && plain.aovs.ids.empty() && plain.aovs.parts.empty() &&
              plain.aovs.materials.empty() && plain.aovs.normal.pixels.empty() &&
              plain.aovs.visibility.empty() && plain.aovs.irradiance.pixels.empty() &&
              plain.aovs.openness.pixels.empty() && plain.aovs.albedo.pixels.empty());
  EXPECT_EQ(draw(scene, everything()).image, plain.image);
}

TEST(Aovs, SayWhatEachPixelSees) {
  const Scene scene = lit_floor();
  const render::FrameResult result = draw(scene, everything());
  const ViewRays view = frame_of(scene, aov_width, aov_height).view;
  const glm::dvec3 axis = -glm::normalize(glm::cross(glm::dvec3(view.dx), glm::dvec3(view.dy)));
  const render::Aovs& aovs = result.aovs;
  ASSERT_EQ(aovs.visibility.size(), 1u);
  EXPECT_TRUE(aovs.openness.pixels.empty());  // as nothing was occluded
  int on_the_floor = 0, background = 0;
  for (int y = 0; y < aov_height; ++y) {
    for (int x = 0; x < aov_width; ++x) {
      const auto i = static_cast<std::size_t>(aov_width * y + x);
      if (aovs.ids[i] == no_triangle) {
        ++background;
        EXPECT_EQ(aovs.depth.pixels[i], std::numeric_limits<float>::infinity());
        EXPECT_EQ(aovs.visibility[0].fraction.pixels[i], 0.0f);
        continue;
      }
      const auto at = on_plane(view, x, y, aovs.ids[i] < 2 ? 0.0 : 1.0);
      ASSERT_TRUE(at);
      on_the_floor += aovs.ids[i] < 2;
      EXPECT_NEAR(aovs.depth.pixels[i], std::abs(glm::dot(*at - glm::dvec3(view.eye), axis)), 1e-5);
      EXPECT_EQ(aovs.parts[i], 0u);
      EXPECT_EQ(aovs.materials[i], 0u);
      const float lit = aovs.visibility[0].fraction.pixels[i];
      EXPECT_EQ(lit, static_cast<float>(result.masks[0].mask.pixels[i]) / 255.0f);
      const glm::dvec3 to_light = glm::normalize(glm::dvec3(lamp_place) - *at);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(aovs.normal.pixels[3 * i + c], c == 1 ? 1.0f : 0.0f);
        EXPECT_NEAR(aovs.irradiance.pixels[3 * i + c], lamp_intensity * lit * to_light.y, 1e-5);
        EXPECT_NEAR(aovs.albedo.pixels[3 * i + c], scene.materials[0].base_color[static_cast<int>(c)], 1e-6);
      }
    }
  }
  EXPECT_GT(on_the_floor, 1000);
  EXPECT_GT(background, 10);
}

}  // namespace
}  // namespace tenebra
