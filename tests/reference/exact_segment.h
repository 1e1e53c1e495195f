// Does one triangle block one segment? The rule of soft shadows by exact arithmetic; shares no code with the
// culling and the solvers that it judges.
#pragma once

#include <glm/glm.hpp>

#include "points/triangle_corners.h"

namespace tenebra::reference {

/// Sign of n.(x - a) - offset with n = (b - a) x (c - a) of the triangle (a, b, c), exact.
int height_sign(const points::Corners& triangle, const glm::dvec3& x, double offset = 0);

/// Whether the closed triangle meets the segment pq with p more than theta / |n| off its plane (theta: the
/// threshold of n.(p - a), contact rule) and p, q strictly on different sides of it. Exact.
bool blocks(const points::Corners& triangle, double theta, const glm::dvec3& p, const glm::dvec3& q);

}  // namespace tenebra::reference
