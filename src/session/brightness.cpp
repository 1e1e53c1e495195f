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

/// What white shows where it faces the sky of a scene whose brightness is measured, before the steps below.
constexpr float shown_sky = 0.14f;
/// Steps by which that sky takes an exposure down. What the meter lets show 0.76 is 0.76 to 0.8 before the
/// neutral tone, which takes off more of what is greyer; (0.76 + 0.14) / 2^(2/8) is less than 0.76.
constexpr int steps_of_sky = 2;

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

Sky wanted_sun(const SceneSettings& settings, const Scene& scene, bool environment) {
  if (settings.sky != Sky::automatic) return settings.sky;
  const bool lit =
      environment || !settings.edits.added.empty() || (settings.emissive_lights && any_mesh_shines(scene));
  return lit ? Sky::none : Sky::automatic;
}

Expected<void> settle_brightness(const SceneSettings& settings, bool stated, StagedScene& staged) {
  if (!settings.shows) return {};
  const bool units = staged.light_has_units;
  const bool shines = !stated && settings.emissive_lights && any_mesh_shines(staged.scene);
  if (shines && settings.sky == Sky::none) staged.scene.ambient_light = glm::vec3(0.0f);
  const bool lamps = units || shines;
  const bool sky =
      settings.sky == Sky::soft || (settings.sky == Sky::automatic && lamps && !staged.environment);
  const bool unknown = lamps || (!stated && (!settings.edits.added.empty() || !settings.environment.empty()));
  if (sky && !unknown) add_sky(stage::default_ambient, staged);
  const bool scaled_sky = sky && unknown, automatic = unknown && !settings.exposure_given;
  if (!scaled_sky && !automatic && !settings.meter_exposure) return {};
  const auto metered = meter(staged, settings);
  if (!metered) return tl::unexpected(metered.error());
  const auto tone = static_cast<std::size_t>(shade::Tone::neutral);
  const float exposure = metered->exposures()[tone];
  const bool as_it_is = !units && metered->one_will_do;
  if (scaled_sky) add_sky(shown_sky / (as_it_is ? std::max(exposure, 1.0f) : exposure), staged);
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
