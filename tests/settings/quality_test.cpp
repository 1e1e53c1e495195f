// The presets: what each sets, that it sets nothing else, and that exact is exact.
#include "settings/quality.h"
#include "render/render_fixture.h"

namespace tenebra {
namespace {

TEST(Quality, NamesLeadBackToPresets) {
  for (const settings::Quality quality : settings::qualities)
    EXPECT_EQ(settings::quality_of(settings::quality_settings(quality)), quality);
  render::RenderSettings between = settings::quality_settings(settings::Quality::fast);
  between.ao.rays = 17;
  EXPECT_EQ(settings::quality_of(between), std::nullopt);
}

TEST(Quality, SetsWhatItStandsFor) {
  render::RenderSettings settings;
  settings::apply_quality(settings::Quality::fast, settings);
  EXPECT_EQ(settings.soft_points, 0);
  EXPECT_EQ(settings.soft.error_255, 4);
  EXPECT_EQ(settings.ao.rays, 16);
  EXPECT_EQ(settings.ao.downscale, 2);
  settings::apply_quality(settings::Quality::exact, settings);
  EXPECT_EQ(settings.soft_points, 0);
  EXPECT_EQ(settings.ao.rays, 256);
  EXPECT_EQ(settings.ao.downscale, 1);
  settings::apply_quality(settings::Quality::balanced, settings);
  EXPECT_EQ(settings.soft_points, render::RenderSettings{}.soft_points);
  EXPECT_EQ(settings.ao.rays, AoConfig{}.rays);
  EXPECT_EQ(settings.ao.downscale, AoConfig{}.downscale);
}

TEST(Quality, LeavesAlone) {
  render::RenderSettings settings{
      .width = 7, .height = 5, .shadows = render::ShadowMode::soft, .light = 3, .exposure = 2};
  settings.hard.variant = Variant::spheres;
  settings.soft.solver = SoftSolver::bsp;
  settings.ao.mode = AoMode::rays;
  settings.ao.positions = 99;
  for (const settings::Quality quality : settings::qualities) {
    settings::apply_quality(quality, settings);
    EXPECT_EQ(settings.width, 7);
    EXPECT_EQ(settings.shadows, render::ShadowMode::soft);
    EXPECT_EQ(settings.light, 3);
    EXPECT_EQ(settings.exposure, 2);
    EXPECT_EQ(settings.hard.variant, Variant::spheres);
    EXPECT_EQ(settings.soft.solver, SoftSolver::bsp);
    EXPECT_EQ(settings.ao.mode, AoMode::rays);
    EXPECT_EQ(settings.ao.positions, 99);
  }
}

Scene plate_scene() {
  Scene scene = white_floor(true);
  scene.ambient_light = glm::vec3(0.3f);
  add_light(scene, {.name = "lamp", .falloff = Falloff::none, .intensity = 0.5f}, {1, 4, 0});
  return scene;
}

io::Image8 picture(const render::RenderSettings& settings) {
  return draw(plate_scene(), settings).image;
}

TEST(Quality, ExactAndBalancedShadowsHaveTheBitsOfTheDefault) {
  for (const render::ShadowMode mode : {render::ShadowMode::hard, render::ShadowMode::soft}) {
    render::RenderSettings settings{.width = 121, .height = 91, .shadows = mode};
    settings.area_lights.size = {1, 1};
    const io::Image8 expected = picture(settings);
    for (const settings::Quality quality : {settings::Quality::exact, settings::Quality::balanced}) {
      settings::apply_quality(quality, settings);
      EXPECT_EQ(picture(settings), expected) << settings::quality_name(quality);
    }
    settings::apply_quality(settings::Quality::fast, settings);
    if (mode == render::ShadowMode::hard) {
      EXPECT_EQ(picture(settings), expected) << "hard shadows are exact in every preset";
    } else {
      EXPECT_EQ(picture(settings), expected) << "few occluders: nothing is quicker than exact";
    }
  }
}

TEST(Quality, BalancedOcclusionHasTheBitsOfTheDefault) {
  render::RenderSettings settings{.width = 81, .height = 61, .shadows = render::ShadowMode::none};
  settings.ao.mode = AoMode::field;
  const io::Image8 expected = picture(settings);
  settings::apply_quality(settings::Quality::balanced, settings);
  EXPECT_EQ(picture(settings), expected);
}

}  // namespace
}  // namespace tenebra
