// Many frames of a moving scene in one process: its memory does not grow once it has seen every frame.
#include <gtest/gtest.h>

#include <unistd.h>
#include <algorithm>
#include <cstdint>

#include <fstream>

#include "formats/import_scene.h"
#include "render/renderer.h"

namespace tenebra {
namespace {

std::int64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::int64_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * ::sysconf(_SC_PAGESIZE);
}

// Ten instants of the scene's clip, drawn over and over.
class Loop {
public:
  Loop(const Scene& scene, const render::RenderSettings& settings) : scene_(scene), settings_(settings) {}

  void draw(render::Renderer& renderer, int times) {
    for (int i = 0; i < times; ++i) {
      const double time_s =
          scene_.clips[0].start_s + (i % 10) * 0.1 * (scene_.clips[0].end_s - scene_.clips[0].start_s);
      evaluate_frame(scene_, 0, time_s, input_.geometry);
      input_.lights = evaluate_lights(scene_, 0, time_s);
      input_.view = evaluate_camera(scene_, 0, time_s, 0, settings_.width, settings_.height);
      const auto drawn = renderer.render_frame(input_, settings_, result_);
      ASSERT_TRUE(drawn) << drawn.error().message;
    }
  }

private:
  const Scene& scene_;
  const render::RenderSettings settings_;
  render::FrameInput input_;
  render::FrameResult result_;
};

/// Draws `scene` over and over; a round that takes no more memory than the one before ends it.
void expect_memory_stands_still(const char* file, const render::RenderSettings& settings,
                                int frames_a_round) {
  // A sanitizer's own memory grows from round to round.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep freed memory for a while and need memory of their own";
#endif
  const auto scene = formats::import_scene(file);
  ASSERT_TRUE(scene) << scene.error().message;
  auto context = gl::Context::create(gl::ContextKind::automatic);
  ASSERT_TRUE(context) << context.error().message;
  auto renderer = render::Renderer::create(std::move(*context), *scene);
  ASSERT_TRUE(renderer) << renderer.error().message;
  Loop loop(*scene, settings);
  loop.draw(*renderer, 20);  // buffers reach their sizes, threads and shaders are there
  // A leak grows with every round; what a thread touches late (stack, libraries, scratch for the heaviest
  // task, which on a busy machine it may be given only now) comes once: of 72 rounds beside others 13 took
  // pages.
  std::int64_t least_growth = INT64_MAX;
  for (int round = 0; round < 12 && least_growth > 0; ++round) {
    const std::int64_t warm = resident_bytes();
    loop.draw(*renderer, frames_a_round);
    least_growth = std::min(least_growth, resident_bytes() - warm);
  }
  EXPECT_LE(least_growth, 0);
}

TEST(Endurance, FiftyMoreFramesTakeNoMoreMemory) {
  expect_memory_stands_still(TENEBRA_SCENES_DIR "/gallery.glb", {.width = 200, .height = 150}, 50);
}

TEST(Endurance, TwentyMoreFramesWithSoftShadowsTakeNoMoreMemory) {
  render::RenderSettings settings{.width = 120, .height = 90, .shadows = render::ShadowMode::soft};
  settings.area_lights = {.size = glm::vec2(2.0f), .percent_of_diagonal = true};
  expect_memory_stands_still(TENEBRA_SCENES_DIR "/city.glb", settings, 20);
}

}  // namespace
}  // namespace tenebra
