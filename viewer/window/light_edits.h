// What the user changes about the lights of a scene: on or off, brightness, place, size.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "base/expected.h"
#include "scene/frame_geometry.h"

namespace tenebra::viewer {

struct LightEdit {
  bool on = true;
  float intensity = 1;   ///< factor of the scene's
  glm::vec3 move{0.0f};  ///< metres, world space, added to where the animation has it
  float size = 1;        ///< area lights: factor of width and height

  bool operator==(const LightEdit&) const = default;
};

/// One a light of Scene::lights; lights beyond the end are as the scene has them.
using LightEdits = std::vector<LightEdit>;

/// "N KEY=VALUE ...": `1 on=0`, `0 intensity=2 move=0,1.5,0 size=0.5`. The edit of light N in `edits`, which
/// grows as needed.
Expected<void> parse_light_edit(const std::string& text, LightEdits& edits);
/// The same as text; "" for an edit that changes nothing.
std::string light_edit_text(int light, const LightEdit& edit);

/// The lights of the scene with their brightness and size as edited.
std::vector<Light> edited_lights(const std::vector<Light>& lights, const LightEdits& edits);
/// The lights of an instant as edited: those that are off are left out.
std::vector<WorldLight> edited_lights(std::vector<WorldLight> lights, const LightEdits& edits);

}  // namespace tenebra::viewer
