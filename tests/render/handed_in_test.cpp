// Ids that another renderer has drawn: with those of our own raster a frame is the one that it would be.
#include "render/render_fixture.h"

namespace tenebra {
namespace {

TEST(HandedInIds, GiveTheFrameThatTheirRasterWouldHave) {
  Scene scene = white_floor(true);
  add_light(scene, {.name = "lamp", .type = LightType::point, .falloff = Falloff::none, .intensity = 0.5f},
            {0, 5, 0});
  const render::RenderSettings settings{.width = 64, .height = 48};
  render::Renderer renderer = renderer_for(scene);
  render::FrameInput input = frame_of(scene, settings.width, settings.height);
  render::FrameResult drawn, handed_in;
  ASSERT_TRUE(renderer.render_frame(input, settings, drawn));
  const auto ids = renderer.triangle_ids();
  input.ids.assign(ids.begin(), ids.end());
  ASSERT_TRUE(renderer.render_frame(input, settings, handed_in));
  EXPECT_EQ(handed_in.image, drawn.image);
  EXPECT_EQ(handed_in.masks[0].mask, drawn.masks[0].mask);

  input.ids.back() = 12345;  // no triangle has this number
  ASSERT_TRUE(renderer.render_frame(input, settings, handed_in));
  EXPECT_EQ(handed_in.masks[0].mask.pixels.back(), 0);
}

TEST(HandedInIds, AreRefusedWhereTheyDoNotFit) {
  const Scene scene = white_floor(false);
  render::Renderer renderer = renderer_for(scene);
  render::FrameInput input = frame_of(scene, 8, 6);
  render::FrameResult result;
  input.ids.resize(47);
  const auto refused = renderer.render_frame(input, {.width = 8, .height = 6}, result);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "ids that were handed in: found 47, expected 8x6");
  input.ids.resize(48);
  EXPECT_FALSE(renderer.render_frame(input, {.width = 8, .height = 6, .antialias = 4}, result));
  EXPECT_TRUE(renderer.render_frame(input, {.width = 8, .height = 6}, result));
}

TEST(AdoptedContext, DrawsTheFrameOfOneOfOurOwn) {
  const Scene scene = white_floor(true);
  const render::RenderSettings settings{.width = 64, .height = 48, .antialias = 4};
  const render::FrameResult own = draw(scene, settings);
  const auto window = gl::Context::create(gl::ContextKind::automatic);
  ASSERT_TRUE(window) << window.error().message;
  auto adopted = gl::Context::adopt(window->function_loader());
  ASSERT_TRUE(adopted && adopted->is_adopted());
  auto renderer = render::Renderer::create(std::move(*adopted), scene);
  ASSERT_TRUE(renderer) << renderer.error().message;
  render::FrameResult result;
  ASSERT_TRUE(renderer->render_frame(frame_of(scene, settings.width, settings.height), settings, result));
  EXPECT_EQ(result.image, own.image);
}

}  // namespace
}  // namespace tenebra
