// Pictures as the viewer makes them: whatever previews came before, the whole picture has the bits of render.
#include <gtest/gtest.h>

#include "viewer_picture.h"
#include "viewer_test_scene.h"
#include "window/frames/frame_maker.h"

namespace tenebra::viewer {
namespace {

FrameRequest request_for(const std::shared_ptr<const session::StagedScene>& plan,
                         const render::RenderSettings& asked) {
  FrameRequest request;
  request.scene = plan;
  request.clip = plan->clip;
  request.camera = plan->camera;
  request.a = asked;
  request.a.width = plan->size.width;
  request.a.height = plan->size.height;
  return request;
}

std::vector<PreviewLevel> levels_of(const FrameRequest& request) {
  return preview_levels(preview_subject(request.scene.get(), request.a, false, false));
}

io::Image8 made(FrameMaker& maker, const FrameRequest& request, PreviewLevel level, double time_s) {
  const auto picture = maker.make(request, level, time_s, {}, StopFlag());
  EXPECT_TRUE(picture) << picture.error().message;
  if (!picture) return {};
  EXPECT_EQ((*picture)->preview.empty(), level == PreviewLevel{});
  EXPECT_EQ((*picture)->whole.width, request.a.width);
  return (*picture)->a.result.image;
}

/// Previews of all levels, of this moment and another, then the whole picture; beside one drawn alone.
void expect_whole_after_previews(const SceneOptions& options, const render::RenderSettings& asked) {
  auto planned = session::stage_scene(options);
  ASSERT_TRUE(planned) << planned.error().message;
  const auto plan = std::make_shared<const session::StagedScene>(std::move(*planned));
  const io::Image8 alone = testing::picture_of(*plan, options, 1.25, asked);
  const FrameRequest request = request_for(plan, asked);
  FrameMaker maker(render::RasterChoice{});
  for (const double time_s : {0.5, 1.25}) {
    for (const PreviewLevel level : levels_of(request)) {
      if (level != PreviewLevel{}) made(maker, request, level, time_s);
    }
  }
  EXPECT_EQ(made(maker, request, {}, 1.25), alone);
}

TEST(FrameMaker, WholePicturesHaveTheBitsOfRenderAfterAnyPreviews) {
  const testing::TemporaryFolder folder;
  SceneOptions options;
  options.file = testing::write_moving_scene(folder, 2).string();
  options.size = Size{163, 121};  // that no divisor divides
  render::RenderSettings soft;
  soft.shadows = render::ShadowMode::soft;
  soft.area_lights.size = {1, 0.5f};
  render::RenderSettings field;
  field.ao.mode = AoMode::field;
  field.ao.positions = 100;
  field.ao.directions = 64;
  render::RenderSettings both = soft;
  both.ao = field.ao;
  both.ao.downscale = 2;
  both.antialias = 4;
  for (const render::RenderSettings& asked : {render::RenderSettings{}, soft, field, both})
    expect_whole_after_previews(options, asked);
}

TEST(FrameMaker, WholePicturesOfABundledSceneHaveTheBitsOfRenderAfterAnyPreviews) {
  SceneOptions options;
  options.file = TENEBRA_SCENES_DIR "/city.glb";
  options.size = Size{97, 73};
  render::RenderSettings asked;
  asked.shadows = render::ShadowMode::soft;
  asked.area_lights.size = {4, 4};
  asked.area_lights.percent_of_diagonal = true;
  asked.ao.mode = AoMode::field;
  asked.ao.positions = 100;
  asked.ao.directions = 64;
  expect_whole_after_previews(options, asked);
}

/// The moving scene in a small picture, as asked for without any settings.
struct SmallRequest {
  SmallRequest() {
    options.file = testing::write_moving_scene(folder).string();
    options.size = Size{160, 120};
    plan = std::make_shared<const session::StagedScene>(std::move(*session::stage_scene(options)));
    request = request_for(plan, {});
  }

  testing::TemporaryFolder folder;
  SceneOptions options;
  std::shared_ptr<const session::StagedScene> plan;
  FrameRequest request;
};

TEST(FrameMaker, AStoppedPictureLeavesNoTrace) {
  const SmallRequest small;
  FrameMaker maker(render::RasterChoice{});
  StopFlag stop;
  stop.request();
  const auto stopped = maker.make(small.request, {PreviewMethod::as_asked, 2}, 0.5, {}, stop);
  ASSERT_FALSE(stopped);
  EXPECT_TRUE(is_stop(stopped));
  EXPECT_EQ(made(maker, small.request, {}, 1.25), testing::picture_of(*small.plan, small.options, 1.25, {}));
}

TEST(FrameMaker, APlaceOfAPreviewIsThatOfTheWholePicture) {
  const SmallRequest small;
  FrameMaker maker(render::RasterChoice{});
  EXPECT_FALSE(maker.visible_point({0.5, 0.8})) << "no picture yet";
  made(maker, small.request, {}, 0);
  const auto whole = maker.visible_point({0.5, 0.8});
  made(maker, small.request, {PreviewMethod::as_asked, 4}, 0);
  const auto preview = maker.visible_point({0.5, 0.8});
  ASSERT_TRUE(whole);
  ASSERT_TRUE(preview);
  EXPECT_LT(glm::distance(*whole, *preview), 0.4f) << "within a pixel of the preview";
}

}  // namespace
}  // namespace tenebra::viewer
