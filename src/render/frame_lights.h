// The lights that a frame draws, each with the shadows it gets.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/area_lights.h"
#include "shade/light_terms.h"

namespace tenebra::render {

using shade::DrawnLight;  // the one type of a light in a frame

/// Whether one of them has an area.
bool has_areas(std::span<const DrawnLight> lights);

/// Whether points behind the polygon may see light: not from a spot light whose cone is a half-space or less.
bool shines_behind(const DrawnLight& light);

/// The lights of `input` that `settings` asks for, with polygons in soft mode. Lights that keep hard shadows
/// there and emissive meshes that are no lights are named in `notes`, one sentence each. Fails on a number
/// that the frame does not have.
Expected<std::vector<DrawnLight>> drawn_lights(const Scene& scene, const FrameInput& input,
                                               const RenderSettings& settings,
                                               std::vector<std::string>& notes);

}  // namespace tenebra::render
