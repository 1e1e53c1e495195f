// The same frames by OpenGL and on the CPU.
#include "render/render_fixture.h"

namespace tenebra {
namespace {

constexpr int raster_width = 240, raster_height = 180;

Scene lit_floor(bool with_glass) {
  Scene scene = white_floor(true);
  add_light(scene, {.name = "lamp", .type = LightType::point, .falloff = Falloff::none, .intensity = 0.7f},
            {2, 6, 3});
  if (!with_glass) return scene;
  Material glass{.name = "glass", .base_color = {0.9f, 0.4f, 0.2f}};
  glass.alpha_mode = AlphaMode::blend;
  glass.alpha = 0.4f;
  scene.materials.push_back(glass);
  Mesh pane{.name = "pane"};
  add_quad(pane, {-2, 0, 3}, {4, 0, 0}, {0, 2, 0}, 1);
  add_mesh(scene, std::move(pane));
  return scene;
}

render::FrameResult drawn_by(const Scene& scene, render::RasterKind kind,
                             render::RenderSettings settings = {}) {
  settings.width = raster_width, settings.height = raster_height;
  auto raster = render::FrameRaster::create({.kind = kind});
  EXPECT_TRUE(raster) << raster.error().message;
  EXPECT_EQ(raster->is_gl(), kind == render::RasterKind::gl);
  render::Renderer renderer = render::Renderer::create(std::move(*raster), scene);
  render::FrameResult result;
  const auto done = renderer.render_frame(frame_of(scene, raster_width, raster_height), settings, result);
  EXPECT_TRUE(done) << done.error().message;
  return result;
}

int differing(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, int most) {
  EXPECT_EQ(a.size(), b.size());
  int count = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    count += std::abs(int{a[i]} - int{b[i]}) > most;
  return count;
}

TEST(RasterKinds, PicturesAndMasksDifferAtEdgesAlone) {
  for (const bool glass : {false, true}) {
    const Scene scene = lit_floor(glass);
    for (const render::SampleSource samples : {render::SampleSource::ids, render::SampleSource::depth}) {
      render::RenderSettings settings{.samples = samples};
      settings.hard.cull_front = samples == render::SampleSource::depth;
      const render::FrameResult gl = drawn_by(scene, render::RasterKind::gl, settings),
                                cpu = drawn_by(scene, render::RasterKind::cpu, settings);
      ASSERT_EQ(gl.masks.size(), 1u);
      ASSERT_EQ(cpu.masks.size(), 1u);
      // Edges of three quads: a row of pixels is the worst case.
      EXPECT_LT(differing(gl.image.pixels, cpu.image.pixels, 1), 3 * raster_width / 4);
      EXPECT_LT(differing(gl.masks[0].mask.pixels, cpu.masks[0].mask.pixels, 0), raster_width / 4);
      EXPECT_GT(std::count(cpu.masks[0].mask.pixels.begin(), cpu.masks[0].mask.pixels.end(), 255),
                raster_width);
    }
  }
}

TEST(RasterKinds, TheCpuGivesTheSameBitsWithAnyThreadsAndVectors) {
  const Scene scene = lit_floor(true);
  const render::FrameResult expected = drawn_by(scene, render::RasterKind::cpu);
  for (const int threads : {1, 3}) {
    for (const SimdLevel level : {SimdLevel::scalar, best_simd_level()}) {
      render::RenderSettings settings{.threads = threads};
      settings.hard.simd = level;
      EXPECT_EQ(drawn_by(scene, render::RasterKind::cpu, settings).image.pixels, expected.image.pixels);
    }
  }
}

TEST(RasterKinds, TheCpuNeedsNoContextAndReadsNothingBack) {
  const render::FrameResult cpu = drawn_by(lit_floor(false), render::RasterKind::cpu);
  EXPECT_GT(cpu.timings.raster_ms, 0);
  EXPECT_EQ(cpu.timings.readback_ms, 0);
}

TEST(RasterKinds, VisiblePointsAreThoseOfTheLastFrame) {
  const Scene scene = white_floor(false);
  auto raster = render::FrameRaster::create({.kind = render::RasterKind::cpu});
  render::Renderer renderer = render::Renderer::create(std::move(*raster), scene);
  const render::FrameInput input = frame_of(scene, raster_width, raster_height);
  EXPECT_FALSE(renderer.visible_point(input, 5, 5)) << "no frame yet";
  render::FrameResult result;
  ASSERT_TRUE(renderer.render_frame(input, {.width = raster_width, .height = raster_height}, result));
  const auto point = renderer.visible_point(input, raster_width / 2, raster_height / 2);
  const auto expected = on_plane(input.view, raster_width / 2, raster_height / 2);
  ASSERT_TRUE(point && expected);
  EXPECT_LT(glm::length(*point - *expected), 1e-9);
}

}  // namespace
}  // namespace tenebra
