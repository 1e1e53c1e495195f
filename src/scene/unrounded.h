// Where a scene's vertices are before they are rounded to floats.
#pragma once

#include <functional>

#include <tenebra/frame_geometry.h>

namespace tenebra::scene {

/// Calls visit(vertex, place) for each vertex of evaluate_frame's, in their order: world space, in double,
/// from Mesh::unrounded where a mesh has it and keeps its shape.
void each_unrounded(const Scene& scene, int clip, double time_s,
                    const std::function<void(std::size_t, const glm::dvec3&)>& visit);

}  // namespace tenebra::scene
