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
    EXPECT_NEAR(lit.scene.ambient_light.x * exposure(lit), 0.15 / std::exp2(0.125), 1e-4);
    EXPECT_EQ(lit.scene.background, lit.scene.ambient_light);
    EXPECT_TRUE(says(lit, "have units: pictures are exposed by 0.0") && says(lit, "soft grey sky"));
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
  EXPECT_TRUE(staged(settings).added.light);
  settings.emissive_lights = true;
  EXPECT_FALSE(staged(settings).added.light);
}

}  // namespace
}  // namespace tenebra::session
