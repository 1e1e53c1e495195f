// What the user changes about the lights of a scene: on or off, colour, brightness, place, direction, size.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include <tenebra/frame_geometry.h>

namespace tenebra::stage {

struct LightEdit {
  bool on = true;
  float intensity = 1;   ///< factor of the scene's
  glm::vec3 move{0.0f};  ///< metres, along the axes of the scene's file, added to where the animation has it
  std::optional<glm::vec2> size_m;    ///< width and height, world space; none: the scene's, of a point
                                      ///< light that of the method
  std::optional<float> diameter_deg;  ///< of a directional light; 0: hard; none: the method's, or the scene's
  std::optional<glm::vec3> color;     ///< in place of the scene's
  std::optional<glm::vec3> direction;  ///< in the file's axes, the way it shines; of any length but zero
  bool deleted = false;                ///< off, and listed nowhere; as text it is off

  bool operator==(const LightEdit&) const = default;
};

/// One for each light of Scene::lights; lights beyond the end are as the scene has them.
using LightEdits = std::vector<LightEdit>;

/// The edit of light `light`; one that changes nothing where `edits` has none.
LightEdit edit_of(const LightEdits& edits, int light);

/// The lights of the scene with their colour and brightness as edited; those that are off have none.
std::vector<Light> edited_lights(std::vector<Light> lights, const LightEdits& edits);
/// The lights of an instant, moved, resized and turned as edited. `frame`: the scene's.
std::vector<WorldLight> edited_lights(std::vector<WorldLight> lights, const LightEdits& edits,
                                      const FileFrame& frame);
/// Sizes of the point and spot lights that have their own, for AreaLightSettings::own_size_m.
std::vector<std::optional<glm::vec2>> edited_sizes_m(const LightEdits& edits);
/// Diameters of the directional lights that have their own, for AreaLightSettings::own_sun_deg.
std::vector<std::optional<float>> edited_suns_deg(const LightEdits& edits);

}  // namespace tenebra::stage
