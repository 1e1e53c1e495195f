// Which triangles cast shadows from one light.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/visible_points.h>
#include "render/frame_lights.h"

namespace tenebra::render {

/// The frame's triangles with the casters of `light`: all but those of Light::left_out_nodes, and those that
/// lie in the plane of its polygon. `storage` holds the casters where they differ from
/// FrameGeometry::casts_shadow; keep it as long as the view.
TriangleView casters_of(const Scene& scene, const FrameGeometry& geometry, const DrawnLight& light,
                        std::vector<std::uint8_t>& storage);

}  // namespace tenebra::render
