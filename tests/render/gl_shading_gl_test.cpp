// Whole frames whose colours OpenGL makes, against the CPU's, of the bundled scenes: the same masks, and
// pictures at most a level apart but for rare samples.
#include <filesystem>

#include "formats/import_scene.h"
#include "render/render_fixture.h"
#include "support/contexts.h"

namespace tenebra {
namespace {

using render::FrameResult;
using render::RasterKind;
using render::RenderSettings;
using render::ShadowMode;

class GlShading : public ::testing::TestWithParam<gl::ContextKind> {
protected:
  void SetUp() override { TENEBRA_NEEDS_CONTEXT(GetParam()); }

  /// Both rasterise on the CPU: the ids are the same.
  static FrameResult drawn(const Scene& scene, const RenderSettings& settings, RasterKind shading,
                           int frame = 20) {
    render::RasterChoice choice{.kind = RasterKind::cpu, .shading = shading};
    choice.context = GetParam();
    auto raster = render::FrameRaster::create(choice);
    EXPECT_TRUE(raster) << raster.error().message;
    EXPECT_EQ(raster->shades_by_gl(), shading == RasterKind::gl);
    render::Renderer renderer = render::Renderer::create(std::move(*raster), scene);
    const double time_s = frame / 30.0;
    const int clip = scene.clips.empty() ? -1 : 0;
    render::FrameInput input;
    evaluate_frame(scene, clip, time_s, input.geometry);
    input.lights = evaluate_lights(scene, clip, time_s);
    input.view = evaluate_camera(scene, clip, time_s, 0, settings.width, settings.height);
    FrameResult result;
    const auto done = renderer.render_frame(input, settings, result);
    EXPECT_TRUE(done) << done.error().message;
    return result;
  }

  /// `by_gl`: OpenGL makes such frames; else the CPU does, and says why.
  static void expect_alike(const Scene& scene, const RenderSettings& settings, bool by_gl = true) {
    const FrameResult cpu = drawn(scene, settings, RasterKind::cpu),
                      gl = drawn(scene, settings, RasterKind::gl);
    const bool left_to_cpu = std::any_of(gl.notes.begin(), gl.notes.end(), [](const std::string& note) {
      return note.find("The CPU makes the colours") != std::string::npos;
    });
    EXPECT_EQ(left_to_cpu, !by_gl);
    ASSERT_EQ(gl.masks.size(), cpu.masks.size());
    for (std::size_t i = 0; i < cpu.masks.size(); ++i) EXPECT_EQ(gl.masks[i].mask, cpu.masks[i].mask);
    ASSERT_EQ(gl.image.pixels.size(), cpu.image.pixels.size());
    std::size_t apart = 0;
    for (std::size_t i = 0; i < cpu.image.pixels.size(); ++i)
      apart += std::abs(cpu.image.pixels[i] - gl.image.pixels[i]) > 1;
    EXPECT_LE(apart, cpu.image.pixels.size() / 1000);
    if (!by_gl) {
      EXPECT_EQ(gl.image, cpu.image);
    }
  }

  static RenderSettings settings(ShadowMode shadows, int antialias) {
    RenderSettings out;
    out.width = 160, out.height = 100;
    out.shadows = shadows;
    out.antialias = antialias;
    return out;
  }
  static Scene bundled(const std::string& file) {
    auto scene = formats::import_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / file);
    EXPECT_TRUE(scene) << scene.error().message;
    return std::move(*scene);
  }
};

TEST_P(GlShading, DrawsTheCityWithHardShadows) {
  const Scene city = bundled("city.glb");
  expect_alike(city, settings(ShadowMode::hard, 1));
  expect_alike(city, settings(ShadowMode::hard, 4));
  expect_alike(city, settings(ShadowMode::none, 4));
}

TEST_P(GlShading, DrawsTheCourtsAreaLights) {
  const Scene court = bundled("court.glb");
  expect_alike(court, settings(ShadowMode::soft, 1));
  expect_alike(court, settings(ShadowMode::hard, 4));
}

TEST_P(GlShading, DrawsOpenness) {
  RenderSettings with_ao = settings(ShadowMode::hard, 4);
  with_ao.ao.mode = AoMode::adaptive;
  expect_alike(bundled("city.glb"), with_ao);
}

TEST_P(GlShading, DrawsGlass) {
  Scene scene = white_floor(true);
  Material pane;
  pane.base_color = {0.75f, 0.5f, 0.25f};
  pane.transmission = 1;
  pane.tinted_transmission = true;
  scene.materials.push_back(pane);
  Mesh mesh{.name = "pane"};
  add_quad(mesh, {1, 2, 1}, {2, 0, 0}, {0, 0, -2}, 1);
  add_mesh(scene, std::move(mesh));
  Light light;
  light.falloff = Falloff::none;
  light.intensity = 0.8f;
  add_light(scene, light, {0, 5, 0});
  scene.cameras.push_back({});
  Node eye{.translation = {0, 8, 8}, .rotation = {std::cos(0.4), -std::sin(0.4), 0, 0}};
  eye.camera = 0;
  scene.nodes.push_back(eye);
  for (const int antialias : {1, 4}) expect_alike(scene, settings(ShadowMode::hard, antialias));
}

TEST_P(GlShading, LeavesToTheCpuWhatItLacksAndSaysSo) {
  RenderSettings linear = settings(ShadowMode::hard, 4);
  linear.linear_mean = true;
  expect_alike(bundled("city.glb"), linear, false);
}

INSTANTIATE_TEST_SUITE_P(, GlShading, ::testing::Values(gl::ContextKind::egl, gl::ContextKind::osmesa),
                         [](const auto& kind) {
                           return kind.param == gl::ContextKind::egl ? "egl" : "osmesa";
                         });

}  // namespace
}  // namespace tenebra
