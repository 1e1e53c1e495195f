// Explanations of pixels agree with the masks, and a renderer takes edited lights and materials.
#include <gtest/gtest.h>

#include "render/explanation.h"
#include "render_fixture.h"

namespace tenebra {
namespace {

using render::DrawnLight;
using render::explain_pixel;
using render::LightExplanation;
using render::PixelExplanation;
using render::RenderSettings;
using render::ShadowMode;
using shadow::LightSight;

/// A floor, and above it a plate that is a node of its own.
Scene floor_and_plate() {
  Scene scene = white_floor(false);
  scene.materials.push_back({.name = "blue", .base_color = {0.1f, 0.2f, 0.9f}});
  Mesh plate{.name = "plate"};
  add_quad(plate, {-1, 1, 1}, {2, 0, 0}, {0, 0, -2}, 1);
  add_mesh(scene, std::move(plate));
  return scene;
}

struct Frame {
  Scene scene;
  RenderSettings settings;
  render::FrameInput input;
  render::Renderer renderer;
  render::FrameResult result;

  explicit Frame(Scene of, RenderSettings with = {})
      : scene(std::move(of)), settings(std::move(with)), renderer(renderer_for(scene)) {
    settings.width = settings.height = 48;
    input = frame_of(scene, settings.width, settings.height);
    const auto drawn = renderer.render_frame(input, settings, result);
    EXPECT_TRUE(drawn) << drawn.error().message;
  }
  PixelExplanation explain(int x, int y) const {
    return explain_pixel({scene,
                          input.geometry,
                          input.view,
                          renderer.triangle_ids(),
                          settings.width,
                          renderer.drawn_lights(),
                          result.masks,
                          settings,
                          {x, y}});
  }
};

TEST(Explanation, AgreesWithTheMaskOfEveryPixel) {
  Scene scene = floor_and_plate();
  add_light(scene, {.name = "lamp", .intensity = 10}, {0, 4, 0});
  add_light(scene, {.name = "sun", .type = LightType::directional}, {0, 0, 0}, facing_down);
  add_light(scene, {.name = "below"}, {0, -2, 0});
  const Frame frame(std::move(scene));
  ASSERT_EQ(frame.result.masks.size(), 3u);
  int blocked = 0, lit = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      const PixelExplanation pixel = frame.explain(x, y);
      if (pixel.background) continue;
      ASSERT_EQ(pixel.lights.size(), 3u);
      for (std::size_t i = 0; i < 3; ++i) {
        const LightExplanation& light = pixel.lights[i];
        const auto index = static_cast<std::size_t>(y * 48 + x);
        ASSERT_EQ(light.sight == LightSight::lit, frame.result.masks[i].mask.pixels[index] == 255);
        ASSERT_EQ(light.occluder.has_value(), light.sight == LightSight::blocked);
        lit += light.sight == LightSight::lit;
        if (!light.occluder) continue;
        ++blocked;
        EXPECT_EQ(light.occluder->node, 1) << "the plate";
        EXPECT_EQ(light.occluder->material, 1);
        EXPECT_NEAR(light.met_at.y, 1, 1e-12);
      }
      EXPECT_EQ(pixel.lights[2].sight, LightSight::faces_away);
      EXPECT_EQ(pixel.lights[0].name, "lamp");
    }
  }
  EXPECT_GT(blocked, 20);
  EXPECT_GT(lit, 1000);
}

TEST(Explanation, NamesWhatHidesMostOfAnAreaLight) {
  Scene scene = floor_and_plate();
  add_light(scene,
            {.name = "panel", .type = LightType::area_rect, .intensity = 10, .size_m = glm::vec2(2.0f)},
            {0, 4, 0}, facing_down);
  RenderSettings settings;
  settings.shadows = ShadowMode::soft;
  const Frame frame(std::move(scene), settings);
  const std::vector<float>& fractions = frame.result.masks[0].visible_fraction.pixels;
  int partly = 0, dark = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      const PixelExplanation pixel = frame.explain(x, y);
      if (pixel.background) continue;
      const LightExplanation& light = pixel.lights.at(0);
      const float fraction = fractions[static_cast<std::size_t>(y * 48 + x)];
      ASSERT_EQ(light.visible_fraction, fraction);
      EXPECT_EQ(light.sight == LightSight::lit, fraction > 0);
      EXPECT_FALSE(fraction == 1 && light.occluder) << "nothing stands before a light that is whole";
      EXPECT_FALSE(fraction == 0 && !light.occluder);
      if (!light.occluder) continue;
      EXPECT_EQ(light.occluder->node, 1);
      EXPECT_GT(light.held_by_it, 0);
      ++(fraction > 0 ? partly : dark);
    }
  }
  EXPECT_GT(partly, 10);
  EXPECT_GT(dark, 2);
}

TEST(Explanation, KnowsTheNodeOfEveryTriangle) {
  Scene scene = floor_and_plate();
  scene.nodes.insert(scene.nodes.begin(), Node{.name = "empty"});
  scene.nodes.push_back({.name = "again", .translation = {0, 1, 0}, .mesh = 0});
  FrameGeometry geometry;
  evaluate_frame(scene, -1, 0, geometry);
  const std::vector<int> expected{1, 1, 2, 2, 3, 3};
  ASSERT_EQ(geometry.triangles.size(), expected.size());
  for (std::uint32_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(render::node_of_triangle(scene, geometry, i), expected[i]);
}

TEST(Renderer, TakesEditedLightsAndMaterialsAsIfTheSceneHadThem) {
  Scene scene = floor_and_plate();
  add_light(scene, {.name = "lamp", .intensity = 10}, {0, 4, 0});
  Frame frame(scene);
  const io::Image8 before = frame.result.image;

  Scene edited = scene;
  edited.materials[0].base_color = {0.5f, 0.1f, 0.1f};
  edited.materials[1].specular = {0.4f, 0.4f, 0.4f};
  add_light(edited, {.name = "second", .color = {0, 1, 0}, .intensity = 20}, {3, 3, 1});
  const Frame fresh(edited);
  ASSERT_NE(fresh.result.image, before);

  frame.renderer.set_lights(edited.lights);
  frame.renderer.set_materials(edited.materials);
  frame.input.lights = evaluate_lights(edited, -1, 0);
  ASSERT_TRUE(frame.renderer.render_frame(frame.input, frame.settings, frame.result));
  EXPECT_EQ(frame.result.image, fresh.result.image);

  frame.renderer.set_lights(scene.lights);
  frame.renderer.set_materials(scene.materials);
  frame.input.lights = evaluate_lights(scene, -1, 0);
  ASSERT_TRUE(frame.renderer.render_frame(frame.input, frame.settings, frame.result));
  EXPECT_EQ(frame.result.image, before) << "and back again";
}

}  // namespace
}  // namespace tenebra
