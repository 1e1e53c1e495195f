#include "session/brightness.h"

#include <fmt/core.h>

#include <algorithm>

#include "render/emissive.h"
#include "session/auto_exposure.h"
#include "stage/default_light.h"

namespace tenebra::session {
namespace {

using settings::SceneSettings;
using stage::Sky;

/// What white shows where it faces the sky of a scene whose brightness is measured, before the step below.
constexpr float shown_sky = 0.15f;
/// Steps by which that sky takes an exposure down. What was shown at the limit of 0.95 was 1.672 before the
/// neutral tone; (1.672 + 0.15) / 2^(1/8) is less.
constexpr int steps_of_sky = 1;

/// As the first clip begins, which decides what is added.
bool any_mesh_shines(const Scene& scene) {
  const bool emissive = std::any_of(scene.materials.begin(), scene.materials.end(),
                                    [](const Material& m) { return m.emissive != glm::vec3(0.0f); });
  if (!emissive) return false;
  FrameGeometry frame;
  evaluate_frame(scene, scene.clips.empty() ? -1 : 0, scene.clips.empty() ? 0.0 : scene.clips.front().start_s,
                 frame);
  std::vector<std::string> notes;
  return !render::emissive_polygons(scene, frame, notes).empty();
}

void add_sky(float ambient, StagedScene& staged) {
  Scene& scene = staged.scene;
  scene.ambient_light = glm::vec3(ambient);
  if (scene.background == glm::vec3(0.0f)) scene.background = glm::vec3(ambient);
  staged.added.sky = true;
  scene.warnings.push_back(
      fmt::format("The light of a soft grey sky ({:.3g}) was added, for what no light reaches (--sky none "
                  "leaves it out).",
                  ambient));
}

}  // namespace

bool states_surroundings(const Scene& scene) {
  return scene.transfer == Transfer::display || scene.ambient_light != Scene{}.ambient_light ||
         scene.background != glm::vec3(0.0f);
}

bool has_units(const Scene& scene) {
  return std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const Node& node) {
    return node.light >= 0 &&
           scene.lights[static_cast<std::size_t>(node.light)].falloff == Falloff::inverse_square;
  });
}

Sky wanted_sun(const SceneSettings& settings, const Scene& scene, bool environment) {
  if (settings.sky != Sky::automatic) return settings.sky;
  const bool lit =
      environment || !settings.edits.added.empty() || (settings.emissive_lights && any_mesh_shines(scene));
  return lit ? Sky::none : Sky::automatic;
}

Expected<void> settle_brightness(const SceneSettings& settings, bool stated, StagedScene& staged) {
  if (!settings.shows) return {};
  const bool units = !stated && has_units(staged.scene);
  const bool sky =
      settings.sky == Sky::soft || (settings.sky == Sky::automatic && units && !staged.environment);
  const bool unknown = units || (!stated && (!settings.edits.added.empty() || !settings.environment.empty()));
  if (sky && !unknown) add_sky(stage::default_ambient, staged);
  const bool scaled_sky = sky && unknown, automatic = unknown && !settings.exposure_given;
  if (!scaled_sky && !automatic && !settings.meter_exposure) return {};
  const auto metered = meter(staged, settings);
  if (!metered) return tl::unexpected(metered.error());
  const auto tone = static_cast<std::size_t>(shade::Tone::neutral);
  if (scaled_sky) add_sky(shown_sky / metered->exposures()[tone], staged);
  settings::SceneDisplay& display = staged.display;
  display.exposures = metered->exposures(scaled_sky ? steps_of_sky : 0);
  display.needs_exposure = automatic && (units || !metered->one_will_do);
  if (display.needs_exposure)
    staged.scene.warnings.push_back(fmt::format(
        "{}: pictures are exposed by {:.3g} with the neutral tone (--exposure sets another factor).",
        units ? "The scene's lights have units" : "An exposure of 1 would show too much or too little",
        (*display.exposures)[tone]));
  return {};
}

}  // namespace tenebra::session
