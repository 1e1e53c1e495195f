// Many frames of a moving scene in one process: what it holds does not grow once it has seen every frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <unistd.h>

#include <fstream>

#include "import/import_scene.h"
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
  explicit Loop(const Scene& scene) : scene_(scene) {}

  void draw(Renderer& renderer, int times) {
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
  const RenderSettings settings_{.width = 200, .height = 150};
  FrameInput input_;
  FrameResult result_;
};

TEST(Endurance, FiftyMoreFramesTakeNoMoreMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep freed memory for a while and need memory of their own";
#endif
  const auto scene = import_scene(TENEBRA_SCENES_DIR "/gallery.glb");
  ASSERT_TRUE(scene) << scene.error().message;
  auto context = gl::Context::create(gl::ContextKind::automatic);
  ASSERT_TRUE(context) << context.error().message;
  auto renderer = Renderer::create(std::move(*context), *scene);
  ASSERT_TRUE(renderer) << renderer.error().message;
  Loop loop(*scene);
  loop.draw(*renderer, 20);  // buffers reach their sizes, threads and shaders are there
  // A leak grows with every fifty frames; a page that a thread touches late (stack, libraries) comes once.
  std::int64_t least_growth = INT64_MAX;
  for (int round = 0; round < 4 && least_growth > 0; ++round) {
    const std::int64_t warm = resident_bytes();
    loop.draw(*renderer, 50);
    least_growth = std::min(least_growth, resident_bytes() - warm);
  }
  EXPECT_LE(least_growth, 0);
}

}  // namespace
}  // namespace tenebra
