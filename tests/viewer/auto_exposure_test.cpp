// --exposure auto: nothing is burnt out, in no frame of no scene, and one exposure serves them all.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include <tenebra/threads.h>
#include "scene_files.h"
#include "session/auto_exposure.h"
#include "session/session.h"
#include "shared/render_plan.h"
#include "viewer_picture.h"
#include "window/view_state.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;
using session::StagedScene;
using viewer::SceneOptions;

double clipped_share(const io::Image8& image) {
  std::size_t clipped = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3)
    clipped += std::max({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]}) == 255;
  return 3.0 * static_cast<double>(clipped) / static_cast<double>(image.pixels.size());
}

/// Times between those that are metered.
std::vector<double> times(const session::StagedScene& plan) {
  if (plan.clip < 0) return {0.0};
  const Clip& clip = plan.scene.clips[static_cast<std::size_t>(plan.clip)];
  std::vector<double> found;
  for (const double part : {0.0, 0.07, 0.19, 0.31, 0.44, 0.57, 0.69, 0.81, 0.94, 1.0})
    found.push_back(clip.start_s + part * (clip.end_s - clip.start_s));
  return found;
}

SceneOptions options_of(const fs::path& file) {
  SceneOptions options;
  options.file = file.string();
  options.size = viewer::Size{160, 120};
  options.meter_exposure = true;
  return options;
}

render::RenderSettings exposed(const session::StagedScene& plan, shade::Tone tone) {
  return {.exposure = (*plan.display.exposures)[static_cast<std::size_t>(tone)], .tone = tone};
}

/// As the program draws it, surroundings included.
io::Image8 drawn_by_session(const session::StagedScene& plan, const SceneOptions& options, double time_s,
                            render::RenderSettings settings) {
  auto session = session::Session::open(std::make_shared<const StagedScene>(plan), options.edits, {});
  EXPECT_TRUE(session) << session.error().message;
  session->place(plan.clip, time_s,
                 session::rays_of(plan, session::viewpoint_of(plan, options), time_s, plan.size));
  settings.width = plan.size.width;
  settings.height = plan.size.height;
  render::FrameResult result;
  const auto drawn = session->draw(settings, result);
  EXPECT_TRUE(drawn) << drawn.error().message;
  return std::move(result.image);
}

TEST(AutoExposure, AtMostTwoPercentOfThePixelsAreClippedInAnyScene) {
  std::size_t drawn = 0;
  for (const fs::path& file : testing::scene_files()) {
    const SceneOptions options = options_of(file);
    const auto plan = session::stage_scene(options);
    ASSERT_TRUE(plan) << plan.error().message;
    for (const double time_s : times(*plan)) {
      for (const shade::Tone tone : {viewer::tone_of({}, plan->scene.transfer), shade::Tone::none}) {
        EXPECT_LE(clipped_share(drawn_by_session(*plan, options, time_s, exposed(*plan, tone))), 0.02)
            << file << " at " << time_s << " s, " << shade::tone_name(tone);
      }
    }
    ++drawn;
  }
  EXPECT_GE(drawn, 4u);
}

TEST(AutoExposure, MoreWouldBeTooMuch) {
  for (const char* name : {"city.glb", "court.glb", "gallery.glb", "square.glb"}) {
    const SceneOptions options = options_of(fs::path(TENEBRA_SCENES_DIR) / name);
    const auto plan = session::stage_scene(options);
    ASSERT_TRUE(plan) << plan.error().message;
    render::RenderSettings settings = exposed(*plan, shade::Tone::none);
    settings.exposure *= 2;
    double worst = 0;
    for (const double time_s : times(*plan))
      worst = std::max(worst, clipped_share(picture_of(*plan, options, time_s, settings)));
    EXPECT_GT(worst, 0.01) << name;
  }
}

TEST(AutoExposure, IsTheSameForEveryFrameThreadCountAndMethod) {
  viewer::RenderOptions options;
  options.scene = options_of(fs::path(TENEBRA_SCENES_DIR) / "gallery.glb");
  options.method.auto_exposure = true;
  std::vector<float> found;
  for (const int frame : {0, 77, 150}) {
    options.frames = viewer::FrameRange{frame, frame, 1};
    options.method.render.threads = frame % 4 + 1;
    options.method.render.shadows = frame == 0 ? render::ShadowMode::soft : render::ShadowMode::hard;
    with_threads(frame % 3 + 1, [&] {
      const auto plan = viewer::plan_render(options);
      ASSERT_TRUE(plan) << plan.error().message;
      found.push_back(plan->settings.exposure);
    });
  }
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
  EXPECT_NE(found[0], 1.0f);
  options.method.auto_exposure = false;
  EXPECT_EQ(viewer::plan_render(options)->settings.exposure, 1.0f);
}

TEST(AutoExposure, IsOneWhereNothingIsSeen) {
  session::StagedScene plan;
  plan.scene.cameras.emplace_back();
  plan.size = {16, 12};
  SceneOptions options;
  options.eye = glm::vec3(0, 0, 1);
  const auto found = session::meter_exposures(plan, options);
  ASSERT_TRUE(found) << found.error().message;
  for (const float exposure : *found) EXPECT_EQ(exposure, 1.0f);
}

TEST(Tone, IsNeutralForLinearColoursAndNoneForDisplayValues) {
  EXPECT_EQ(viewer::tone_of({}, Transfer::srgb), shade::Tone::neutral);
  EXPECT_EQ(viewer::tone_of({}, Transfer::display), shade::Tone::none);
  viewer::MethodOptions options;
  options.tone = shade::Tone::aces;
  EXPECT_EQ(viewer::tone_of(options, Transfer::display), shade::Tone::aces);
  EXPECT_EQ(viewer::render_settings(options, {8, 8}, {}).tone, shade::Tone::aces);
}

TEST(AutoExposure, IsMeasuredAnewInTheWindowOnlyAfterEdits) {
  viewer::ViewState state;
  EXPECT_FALSE(state.is_metered());
  state.display.exposures = settings::AutoExposures{};
  EXPECT_TRUE(state.is_metered());
  state.light_edit(0).intensity = 2;
  EXPECT_FALSE(state.is_metered());
  state.metered_edits = state.edits;
  EXPECT_TRUE(state.is_metered());
}

}  // namespace
}  // namespace tenebra::testing
