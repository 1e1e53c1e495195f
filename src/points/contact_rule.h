// The contact rule: how far behind a triangle's plane a point must lie to be shadowed by it. Derived from the
// rounding of the two triangles' vertices; nothing to tune. Shared by hard and soft shadows.
#pragma once

#include <glm/glm.hpp>

#include "math/vertex_rounding.h"

namespace tenebra::points {

/// tau of a triangle whose largest |coordinate| is 1. For scalars and lanes alike.
inline constexpr double contact_tau = math::vertex_rounding;

/// tau_X = sqrt(3) 2^-24 M_X, M_X the largest |coordinate| of triangle X.
double rounding_tolerance(const glm::vec3 triangle[3]);

/// theta = fl64((tau_T + tau_R) |n|), n = (B - A) x (C - A) of the occluder T: T blocks a point P only if
/// |n.(P - A)| > theta. In double and by these operations: this is the definition.
double contact_threshold(const glm::vec3 occluder[3], double tau_occluder, double tau_receiver);

}  // namespace tenebra::points
