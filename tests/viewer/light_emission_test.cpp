// Hard and soft shadows of one light are equally bright where nothing is in between.
#include <gtest/gtest.h>

#include <filesystem>

#include "session/viewpoint.h"
#include "viewer_picture.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;

struct View {
  fs::path file;
  double time_s = 0;
};

/// One light of a scene without casters, in linear colours.
class Unshadowed {
public:
  explicit Unshadowed(const View& view) : time_s_(view.time_s) {
    options_.file = view.file.string();
    options_.size = viewer::Size{320, 240};
    auto plan = session::stage_scene(options_);
    EXPECT_TRUE(plan) << plan.error().message;
    plan_ = std::move(*plan);
    for (Mesh& mesh : plan_.scene.meshes) mesh.casts_shadow = false;
    plan_.scene.ambient_light = glm::vec3(0.0f);
    plan_.scene.background = glm::vec3(0.0f);
    for (Material& material : plan_.scene.materials) material.emissive = glm::vec3(0.0f);
  }
  double mean(render::ShadowMode shadows, render::LightEmission emission, int light) const {
    auto raster = render::FrameRaster::create({.kind = render::RasterKind::cpu});
    render::Renderer renderer = render::Renderer::create(std::move(*raster), plan_.scene);
    render::FrameInput input;
    evaluate_frame(plan_.scene, plan_.clip, time_s_, input.geometry);
    input.lights = evaluate_lights(plan_.scene, plan_.clip, time_s_);
    input.view = session::rays_of(plan_, session::viewpoint_of(plan_, options_), time_s_, plan_.size);
    render::RenderSettings settings{.width = plan_.size.width, .height = plan_.size.height};
    settings.shadows = shadows;
    settings.area_lights = {.size = glm::vec2(2.0f), .percent_of_diagonal = true, .emission = emission};
    settings.light = light;
    settings.linear = true;
    render::FrameResult result;
    EXPECT_TRUE(renderer.render_frame(input, settings, result));
    double sum = 0;
    for (const float value : result.linear.pixels) sum += value;
    return sum;
  }
  /// Of the light that is made a rectangle.
  double soft_over_hard(render::LightEmission emission) const {
    double soft = 0, hard = 0;
    const auto lights = evaluate_lights(plan_.scene, plan_.clip, time_s_);
    for (int i = 0; i < static_cast<int>(lights.size()); ++i) {
      const LightType type =
          plan_.scene.lights[static_cast<std::size_t>(lights[static_cast<std::size_t>(i)].light)].type;
      if (type != LightType::point && type != LightType::spot) continue;
      hard += mean(render::ShadowMode::hard, emission, i);
      soft += mean(render::ShadowMode::soft, emission, i);
    }
    EXPECT_GT(hard, 0);
    return soft / hard;
  }

private:
  viewer::SceneOptions options_;
  session::StagedScene plan_;
  double time_s_ = 0;
};

std::vector<View> views() {
  std::vector<View> found{{fs::path(TENEBRA_SCENES_DIR) / "city.glb", 5.0}};
  const fs::path bart = fs::path(TENEBRA_SHARED_DIR) / "scenes/bart";
  if (!fs::exists(bart)) return found;
  for (const auto& [file, frame] :
       {std::pair("museum/museum5.aff", 216), std::pair("kitchen/kitchen.aff", 100)}) {
    viewer::SceneOptions options;
    options.file = (bart / file).string();
    const auto plan = session::stage_scene(options);
    EXPECT_TRUE(plan) << plan.error().message;
    const Clip& clip = plan->scene.clips[static_cast<std::size_t>(plan->clip)];
    found.push_back({bart / file, frame_time_s(clip, frame, 30.0)});
  }
  return found;
}

TEST(LightEmission, SoftIsAsBrightAsHardWithinTwoPercent) {
  for (const View& view : views()) {
    const double ratio = Unshadowed(view).soft_over_hard(render::LightEmission::point);
    RecordProperty(view.file.stem().string(), std::to_string(ratio));
    EXPECT_NEAR(ratio, 1.0, 0.02) << view.file;
  }
}

TEST(LightEmission, ADiffuseRectangleIsDarker) {
  const double ratio = Unshadowed(views().front()).soft_over_hard(render::LightEmission::lambert);
  EXPECT_LT(ratio, 0.95);
}

}  // namespace
}  // namespace tenebra::testing
