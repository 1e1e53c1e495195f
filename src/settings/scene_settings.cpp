#include "settings/scene_settings.h"

#include "base/fail.h"

namespace tenebra::settings {

SceneSettings settings_for(const std::string& file, const SceneSettings& before) {
  SceneSettings scene;
  scene.file = file;
  scene.import = before.import;
  scene.import.scene.clear();
  scene.import.root.clear();
  scene.import.placement = {};
  scene.cutout_limit = before.cutout_limit;
  scene.cast_all = before.cast_all;
  scene.transfer = before.transfer;
  scene.environment = before.environment;
  scene.sky = before.sky;
  scene.floor = before.floor;
  scene.plain = before.plain;
  scene.meter_exposure = before.meter_exposure;
  scene.exposure_given = before.exposure_given;
  scene.emissive_lights = before.emissive_lights;
  scene.fps = before.fps;
  return scene;
}

Expected<void> check_scene_settings(const SceneSettings& scene) {
  if (scene.eye && *scene.eye == scene.look_at) return base::fail("--eye and --look-at are the same point");
  if (scene.eye && scene.up.value_or(glm::vec3(1)) == glm::vec3(0.0f))
    return base::fail("--up is 0,0,0, expected a direction");
  return {};
}

}  // namespace tenebra::settings
