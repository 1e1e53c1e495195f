// The lights that a frame draws, each with the shadows it gets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/area_lights.h"

namespace tenebra::render {

struct DrawnLight {
  int number = -1;  ///< index into FrameInput::lights; emissive meshes follow them
  Light light;
  WorldLight placed;
  std::optional<AreaLight> area;  ///< soft shadows of this polygon; none: those of a point, or none at all
  std::optional<AreaLight> back;  ///< shines alike in every direction: the polygon's other side
};

/// Whether one of them has an area.
bool has_areas(const std::vector<DrawnLight>& lights);

/// Whether points behind the polygon may see light: not from a spot light whose cone is a half-space or less.
bool shines_behind(const DrawnLight& light);

/// The lights of `input` that `settings` asks for, with polygons in soft mode. Lights that keep hard shadows
/// there and emissive meshes that are no lights are named in `notes`, one sentence each. Fails on a number
/// that the frame does not have.
Expected<std::vector<DrawnLight>> drawn_lights(const Scene& scene, const FrameInput& input,
                                               const RenderSettings& settings,
                                               std::vector<std::string>& notes);

}  // namespace tenebra::render
