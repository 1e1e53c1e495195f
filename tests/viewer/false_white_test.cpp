// Every scene that lies beside the checkout is drawn, and none of its objects is a white blob.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "scene_files.h"
#include "viewer_picture.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;
using session::StagedScene;
using viewer::SceneOptions;

constexpr std::size_t least_pixels = 50;

/// The scene with a flat colour for each mesh, which is its number.
session::StagedScene numbered(session::StagedScene plan) {
  Scene& scene = plan.scene;
  scene.transfer = Transfer::display;
  scene.materials.clear();
  scene.background = glm::vec3(0.0f);
  plan.environment.reset();
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    Material flat;
    flat.model = SurfaceModel::unlit;
    const std::size_t number = i + 1;
    flat.base_color = glm::vec3(number % 256, number / 256 % 256, number / 65536) / 255.0f;
    scene.materials.push_back(flat);
    std::fill(scene.meshes[i].materials.begin(), scene.meshes[i].materials.end(),
              static_cast<std::uint32_t>(i));
    scene.meshes[i].colors.clear();
  }
  return plan;
}

struct Count {
  std::size_t pixels = 0, white = 0;
};

/// By mesh number.
std::map<std::size_t, Count> count_white(const session::StagedScene& plan, const SceneOptions& options,
                                         double time_s, float exposure = 1) {
  render::RenderSettings lit;
  lit.exposure = exposure;
  render::RenderSettings unlit;
  unlit.shadows = render::ShadowMode::none;
  const io::Image8 seen = picture_of(plan, options, time_s, lit);
  const io::Image8 numbers = picture_of(numbered(plan), options, time_s, unlit);
  std::map<std::size_t, Count> counts;
  for (std::size_t i = 0; i + 2 < seen.pixels.size(); i += 3) {
    const std::size_t number =
        numbers.pixels[i] + 256u * numbers.pixels[i + 1] + 65536u * numbers.pixels[i + 2];
    if (number == 0) continue;
    Count& count = counts[number - 1];
    ++count.pixels;
    count.white += seen.pixels[i] == 255 && seen.pixels[i + 1] == 255 && seen.pixels[i + 2] == 255;
  }
  return counts;
}

void expect_no_white_object(const session::StagedScene& plan, const SceneOptions& options, double time_s) {
  std::size_t objects = 0;
  for (const auto& [number, count] : count_white(plan, options, time_s)) {
    if (count.pixels < least_pixels) continue;
    ++objects;
    const Mesh& mesh = plan.scene.meshes[number];
    EXPECT_LE(2 * count.white, count.pixels) << options.file << " at " << time_s << " s, camera "
                                             << plan.camera << ": " << mesh.name << " " << mesh.source;
  }
  EXPECT_GT(objects, 0u) << options.file;
}

TEST(FalseWhite, WhiteObjectsAreFound) {
  SceneOptions options;
  options.file = TENEBRA_SCENES_DIR "/gallery.glb";
  options.size = viewer::Size{320, 240};
  const auto plan = session::stage_scene(options);
  ASSERT_TRUE(plan) << plan.error().message;
  std::size_t white = 0, objects = 0;
  for (const auto& [number, count] : count_white(*plan, options, 0, 1000)) {
    ++objects;
    white += 2 * count.white > count.pixels;
  }
  EXPECT_GT(objects, 5u);
  EXPECT_GT(2 * white, objects);
}

TEST(FalseWhite, NoObjectIsMostlyWhite) {
  const std::vector<fs::path> files = testing::scene_files();
  for (const fs::path& file : files) {
    SceneOptions options;
    options.file = file.string();
    options.size = viewer::Size{320, 240};
    const auto plan = session::stage_scene(options);
    ASSERT_TRUE(plan) << file << ": " << plan.error().message;
    double start_s = 0, end_s = 0;
    if (plan->clip >= 0) {
      const Clip& clip = plan->scene.clips[static_cast<std::size_t>(plan->clip)];
      start_s = clip.start_s;
      end_s = clip.end_s;
    }
    expect_no_white_object(*plan, options, start_s);
    if (end_s > start_s) expect_no_white_object(*plan, options, 0.5 * (start_s + end_s));
  }
}

}  // namespace
}  // namespace tenebra::testing
