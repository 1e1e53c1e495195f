// Triangles for NFF's round shapes.
#pragma once

#include <glm/glm.hpp>

#include <tenebra/scene.h>

namespace tenebra::formats {

/// An open cone or cylinder between two circles: 2 * sides triangles (one per side towards a radius of zero),
/// smooth normals. `base` and `apex` must differ. `inside`: its front faces the axis.
Mesh make_cone(glm::dvec3 base, double base_radius, glm::dvec3 apex, double apex_radius, int sides,
               bool inside);

inline constexpr int sphere_sides = 24;
inline constexpr int sphere_rings = 12;
Mesh make_sphere(glm::dvec3 center, double radius, bool inside);

}  // namespace tenebra::formats
