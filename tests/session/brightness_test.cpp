// What light a file gets beside its own, and how its pictures are exposed.
#include "session/brightness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "session/auto_exposure.h"
#include "session/session.h"
#include "support/temporary_folder.h"

namespace tenebra::session {
namespace {

/// As Blender exports a plane with a lamp of 1000 W, or whatever the light is, seen from above.
class Brightness : public ::testing::Test {
protected:
  settings::SceneSettings file(LightType type = LightType::point, float intensity = 54351) {
    Scene scene;
    Mesh mesh;
    mesh.positions = {{-6, 0, -6}, {-6, 0, 6}, {6, 0, 6}, {6, 0, -6}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.materials = {0, 0};
    scene.materials.emplace_back();
    scene.meshes = {mesh};
    scene.lights.emplace_back().type = type;
    scene.lights[0].intensity = intensity;
    scene.cameras.emplace_back();
    const glm::dquat down = glm::angleAxis(-0.9, glm::dvec3(1, 0, 0));
    scene.nodes = {{.mesh = 0},
                   {.translation = {1, 5, 1}, .rotation = down, .light = 0},
                   {.translation = {0, 6, 5}, .rotation = down, .camera = 0}};
    return written(scene);
  }
  settings::SceneSettings written(const Scene& scene) {
    settings::SceneSettings settings;
    settings.file = (folder_ / "scene.glb").string();
    settings.size = settings::Size{40, 30};
    EXPECT_TRUE(formats::export_glb(scene, settings.file, 30));
    return settings;
  }
  settings::SceneSettings box() {
    settings::SceneSettings settings;
    settings.file = (folder_ / "box.obj").string();
    std::ofstream(settings.file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    settings.size = settings::Size{40, 30};
    return settings;
  }
  static StagedScene staged(const settings::SceneSettings& settings) {
    auto scene = stage_scene(settings);
    EXPECT_TRUE(scene) << scene.error().message;
    return scene ? std::move(*scene) : StagedScene{};
  }
  static bool says(const StagedScene& staged, const char* words) {
    return std::any_of(staged.scene.warnings.begin(), staged.scene.warnings.end(),
                       [&](const std::string& text) { return text.find(words) != std::string::npos; });
  }
  static float exposure(const StagedScene& staged) {
    return (*staged.display.exposures)[static_cast<std::size_t>(shade::Tone::neutral)];
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Brightness, LightsWithUnitsAreExposedAndASkyFillsWhatTheyLeave) {
  for (const auto& [type, intensity] : {std::pair(LightType::point, 54351.0f),
                                        {LightType::spot, 54351.0f},
                                        {LightType::directional, 2049.0f}}) {
    const StagedScene lit = staged(file(type, intensity));
    EXPECT_TRUE(lit.display.needs_exposure && lit.added.sky);
    EXPECT_LT(exposure(lit), 0.02f);
    EXPECT_NEAR(lit.scene.ambient_light.x * exposure(lit), 0.14 / std::exp2(0.25), 1e-4);
    EXPECT_EQ(lit.scene.background, lit.scene.ambient_light);
    EXPECT_TRUE(says(lit, "have units: pictures are exposed by 0.0") && says(lit, "soft grey sky"));
  }
}

// What a sun of E lux makes a matte surface show is its albedo times E / pi times the sine of its height. The
// meter's steps are eighths, two of them are the sky's.
TEST_F(Brightness, MatteWhiteIsNotCompressed) {
  const StagedScene lit = staged(file(LightType::directional, 2049));
  const double albedo = lit.scene.materials[0].base_color.x;
  const double white = albedo * exposure(lit) * 2049 / 3.14159265 * std::sin(0.9) * std::exp2(0.25);
  EXPECT_LE(white, 0.8001);
  EXPECT_GT(white, 0.8 / std::exp2(0.125));
}

// A power of two, so that nothing is rounded.
TEST_F(Brightness, AUnitChangesNoPicture) {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-600, 0, -600}, {-600, 0, 600}, {600, 0, 600}, {600, 0, -600},
                    {-50, 200, -50}, {-50, 200, 50}, {50, 200, 50}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  mesh.materials = {0, 0, 0};
  scene.materials.emplace_back();
  scene.meshes = {mesh};
  scene.lights = {{.type = LightType::point, .intensity = 54351e4f, .range_m = 900.0f}};
  const glm::dquat down = glm::angleAxis(-0.9, glm::dvec3(1, 0, 0));
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    scene.cameras = {{.projection = projection, .vertical_extent_m = 800, .near_m = 100}};
    scene.nodes = {{.mesh = 0},
                   {.translation = {100, 500, 100}, .light = 0},
                   {.translation = {0, 600, 500}, .rotation = down, .camera = 0}};
    settings::SceneSettings settings = written(scene);
    std::vector<render::FrameResult> drawn(2);
    for (const bool unit : {false, true}) {
      if (unit) settings.import.placement.metres_per_unit = 1.0 / 1024;
      const auto lit = std::make_shared<const StagedScene>(staged(settings));
      auto session = Session::open(lit, settings.edits, {.kind = render::RasterKind::cpu});
      ASSERT_TRUE(session);
      session->place(0, rays_of(*lit, viewpoint_of(*lit, settings), 0, lit->size));
      EXPECT_TRUE(session->draw({.width = 40, .height = 30, .exposure = exposure(*lit)}, drawn[unit]));
    }
    ASSERT_EQ(drawn[1].masks.size(), 1u);
    const std::vector<std::uint8_t>& mask = drawn[0].masks[0].mask.pixels;
    EXPECT_EQ(drawn[1].masks[0].mask.pixels, mask);
    EXPECT_GT(std::count(mask.begin(), mask.end(), 255), 100);
    EXPECT_GT(std::count(mask.begin(), mask.end(), 0), 10);
    EXPECT_EQ(drawn[1].image.pixels, drawn[0].image.pixels);
  }
}

// The limit of the meter holds with the sky too: see brightness.cpp.
TEST_F(Brightness, TheSkyBurnsNothingOut) {
  const settings::SceneSettings settings = file();
  const StagedScene lit = staged(settings);
  const auto again = meter(lit, settings);
  ASSERT_TRUE(again);
  EXPECT_GE(again->exposures()[static_cast<std::size_t>(shade::Tone::neutral)], exposure(lit));
}

TEST_F(Brightness, IsTheUsersWhereTheUserSaysSo) {
  settings::SceneSettings settings = file();
  settings.sky = stage::Sky::none;
  StagedScene lit = staged(settings);
  EXPECT_TRUE(lit.display.needs_exposure && !lit.added.sky);
  EXPECT_EQ(lit.scene.ambient_light, Scene{}.ambient_light);
  settings.exposure_given = true;
  lit = staged(settings);
  EXPECT_FALSE(lit.display.needs_exposure || lit.display.exposures);
  EXPECT_TRUE(lit.scene.warnings.empty());
  settings.sky = stage::Sky::soft;
  EXPECT_GT(staged(settings).scene.ambient_light.x, 1) << "the same, whatever the exposure";
}

TEST_F(Brightness, IsTheFilesWhereItStatesItsSurroundings) {
  for (const char* name : {"city", "court", "gallery", "room", "square"}) {
    settings::SceneSettings settings;
    settings.file = TENEBRA_SCENES_DIR "/" + std::string(name) + ".glb";
    const StagedScene bundled = staged(settings);
    EXPECT_FALSE(bundled.display.needs_exposure || bundled.added.sky || bundled.display.exposures) << name;
  }
}

TEST_F(Brightness, TheUsersLightTakesThePlaceOfTheAddedSun) {
  EXPECT_TRUE(says(staged(box()), "The scene has no light"));
  settings::SceneSettings lit = box();
  lit.edits.added.push_back({.position = {5, 12, 5}, .intensity = 0.8f});
  StagedScene scene = staged(lit);
  EXPECT_FALSE(scene.added.light || scene.added.floor || scene.environment || says(scene, "no light"));
  EXPECT_FALSE(scene.display.needs_exposure);
  lit.edits.added[0].intensity = 500;
  scene = staged(lit);
  EXPECT_TRUE(scene.display.needs_exposure && says(scene, "would show too much or too little"));
  lit.sky = stage::Sky::sun;
  EXPECT_TRUE(staged(lit).added.floor) << "both, where both are asked for";
}

TEST_F(Brightness, EmissiveMeshesThatShineTakeThePlaceOfTheAddedSun) {
  Scene scene;
  scene.materials.emplace_back().emissive = {1, 0.5f, 0.5f};
  Mesh mesh;
  mesh.positions = {{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {0, 0};
  scene.meshes = {mesh};
  scene.nodes = {{.mesh = 0}};
  settings::SceneSettings settings = written(scene);
  StagedScene lit = staged(settings);
  EXPECT_TRUE(lit.added.light && says(lit, "--emissive-lights its emissive meshes shine"));
  settings.emissive_lights = true;
  EXPECT_FALSE(staged(settings).added.light);
}

// A lamp of 2 m x 2 m sends white 3 m below it an eighth of its brightness, and is itself in the picture.
TEST_F(Brightness, EmissiveMeshesThatShineAreExposedByWhatTheyLight) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].emissive = glm::vec3(140);
  Mesh mesh;
  mesh.positions = {{-6, 0, -6}, {-6, 0, 6}, {6, 0, 6}, {6, 0, -6},
                    {-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  mesh.materials = {0, 0, 1, 1};
  scene.meshes = {mesh};
  scene.cameras.emplace_back();
  scene.nodes = {{.mesh = 0}, {.translation = {0, 2, 9}, .camera = 0}};
  settings::SceneSettings settings = written(scene);
  settings.emissive_lights = true;
  StagedScene lit = staged(settings);
  EXPECT_TRUE(lit.display.needs_exposure && lit.added.sky && says(lit, "too much or too little"));
  EXPECT_GT(exposure(lit), 0.02f);
  EXPECT_LT(exposure(lit), 0.06f);
  scene.materials[1].emissive = glm::vec3(4);
  lit = staged([&] {
    settings::SceneSettings dim = written(scene);
    dim.emissive_lights = true;
    return dim;
  }());
  EXPECT_FALSE(lit.display.needs_exposure);
  EXPECT_LE(lit.scene.ambient_light.x, 0.14f) << "the sky is that of an exposure of 1";
  EXPECT_GT(lit.scene.ambient_light.x, 0.03f);
  settings.sky = stage::Sky::none;
  lit = staged(settings);
  EXPECT_EQ(lit.scene.ambient_light, glm::vec3(0));
}

TEST_F(Brightness, AddedLightsHaveTheUnitsOfTheFiles) {
  EXPECT_TRUE(staged(file()).light_has_units);
  EXPECT_FALSE(staged(box()).light_has_units);
  const stage::SceneEdits edits{.added = {{}}};
  EXPECT_EQ(stage::lights_of({}, edits, true)[0].falloff, Falloff::inverse_square);
  EXPECT_EQ(stage::lights_of({}, edits, false)[0].falloff, Falloff::none);
}

}  // namespace
}  // namespace tenebra::session
