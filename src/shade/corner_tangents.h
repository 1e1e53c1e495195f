// Where the x of a normal map points to over a triangle. Internal to shade.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "shade/surfaces.h"
#include "shade/triangle_setup.h"

namespace tenebra::shade {

/// At the corners, for normals turned to the eye's side; w: the sign of the y axis, w * cross(normal, x).
/// Where FrameGeometry has no tangent: where the map's first coordinate grows over this triangle; zero where
/// it does not.
std::array<glm::vec4, 3> corner_tangents(const FrameGeometry& geometry, const TriangleSetup& setup,
                                         const glm::uvec3& corners, const CoordinatePlane& map);

}  // namespace tenebra::shade
