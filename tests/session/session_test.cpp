// A scene being drawn: edits that come and go, several sessions of one scene, scenes as their files have
// them.
#include "session/session.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "support/temporary_folder.h"

namespace tenebra::session {
namespace {

settings::SceneSettings court() {
  settings::SceneSettings settings;
  settings.file = TENEBRA_SCENES_DIR "/court.glb";
  settings.size = settings::Size{64, 48};
  return settings;
}

stage::SceneEdits some_edits() {
  stage::SceneEdits edits;
  edits.light(0) = {.intensity = 0.5f, .move = {0.5f, 0, 0}};
  edits.added.push_back({.type = LightType::point, .position = {0, 3, 0}, .intensity = 0.4f});
  edits.materials[0] = {.color = glm::vec3(0.2f, 0.4f, 0.1f)};
  edits.nodes[1] = {.casts = false};
  return edits;
}

/// The picture of a frame, by soft shadows.
io::Image8 picture(Session& session, int frame) {
  const StagedScene& staged = session.staged();
  const double time_s = staged.time_of_frame(frame);
  session.place(time_s, rays_of(staged, viewpoint_of(staged, court()), time_s, staged.size));
  render::RenderSettings settings{.width = staged.size.width, .height = staged.size.height};
  settings.shadows = render::ShadowMode::soft;
  settings.area_lights.size = glm::vec2(0.3f);
  render::FrameResult result;
  const auto drawn = session.draw(settings, result);
  EXPECT_TRUE(drawn) << drawn.error().message;
  EXPECT_GE(result.timings.total_ms, result.timings.evaluate_ms);
  return result.image;
}

Session opened(const std::shared_ptr<const StagedScene>& staged, const stage::SceneEdits& edits) {
  auto session = Session::open(staged, edits, {.kind = render::RasterKind::cpu});
  EXPECT_TRUE(session) << session.error().message;
  return std::move(*session);
}

TEST(Session, EditsThatComeAndGoLeaveNothingBehind) {
  auto read = stage_scene(court());
  ASSERT_TRUE(read) << read.error().message;
  const auto staged = std::make_shared<const StagedScene>(std::move(*read));
  Session plain = opened(staged, {}), edited = opened(staged, some_edits());
  const io::Image8 before = picture(plain, 20), with_edits = picture(edited, 20);
  EXPECT_NE(before, with_edits);
  plain.edit(some_edits());
  EXPECT_EQ(picture(plain, 20), with_edits);
  plain.edit({});
  EXPECT_EQ(picture(plain, 20), before);
}

TEST(Session, AFileWithoutLightGetsTheSameForPicturesAndForLight) {
  const testing::TemporaryFolder folder;
  settings::SceneSettings settings;
  settings.file = (folder / "triangle.obj").string();
  std::ofstream(settings.file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto complete = stage_scene(settings), for_light = stage_scene(settings, Staging::for_light);
  ASSERT_TRUE(complete && for_light);
  EXPECT_TRUE(complete->added.camera && complete->added.light);
  EXPECT_EQ(complete->scene.lights.size(), 1u);
  EXPECT_TRUE(complete->added.floor && !for_light->added.floor);
  EXPECT_EQ(evaluate_lights(for_light->scene, -1, 0)[0].direction,
            evaluate_lights(complete->scene, -1, 0)[0].direction);
  EXPECT_EQ(for_light->scene.warnings.size(), 1u) << "of the light alone";
}

TEST(Session, KnowsTheFilesThatItReadAndTheTimesOfItsFrames) {
  const auto staged = stage_scene(court());
  ASSERT_TRUE(staged) << staged.error().message;
  ASSERT_EQ(staged->inputs.size(), 1u);
  EXPECT_EQ(staged->inputs[0].filename(), "court.glb");
  EXPECT_GT(staged->frames(), 1);
  EXPECT_LT(staged->time_of_frame(0), staged->time_of_frame(1));
}

}  // namespace
}  // namespace tenebra::session
