// Lights of the scene as polygons that shine: what the soft shadows trace.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include <tenebra/area_light.h>
#include "math/box.h"
#include "render/renderer.h"

namespace tenebra::render {

/// Smallest box around the drawn triangles of a frame.
math::Box<double> box_of(const FrameGeometry& geometry);

/// The polygon of a light: area lights as the file has them; point and spot lights as rectangles of the
/// settings' size, or their own, about their place, facing `settings.facing`, else along a spot's axis or
/// from a point towards the box's centre, their width level; directional lights as suns of the settings'
/// diameter, or their own; those without a size as settings.unsized_... say. None where no size is given.
/// Fails with a sentence where the polygon is none: no area, not finite.
Expected<std::optional<AreaLight>> area_light_of(const Light& light, const WorldLight& placed,
                                                 const AreaLightSettings& settings,
                                                 const math::Box<double>& box);

/// Whether triangle `corners` lies in the light's plane, up to the rounding of both: the quad that shows a
/// lamp's face. In exact arithmetic it blocks nothing of that light; rounded it might hide all of it. A sun
/// has no plane.
bool lies_in_plane(const AreaLight& light, const glm::vec3 corners[3]);

/// `geometry.casts_shadow` without the triangles that lie in the light's plane; returns whether there are
/// any, else `out` is left alone.
bool casters_off_plane(const FrameGeometry& geometry, const AreaLight& light, std::vector<std::uint8_t>& out);

}  // namespace tenebra::render
