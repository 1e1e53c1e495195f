// Exact signs that decide shadows. Inputs are taken as exact reals; every answer is exact. The filters that
// make these calls rare are with the callers.
#pragma once

#include <glm/glm.hpp>

namespace tenebra::math {

/// Sign of det(a - l, b - l, p - l): on which side of the plane through l, a and b the point p lies.
int edge_side(const glm::vec3& l, const glm::vec3& a, const glm::vec3& b, const glm::dvec3& p);
/// The side of such a plane with l at infinity in `direction`: sign of ((b - a) x direction) . (p - a).
int edge_side_infinite(const glm::vec3& direction, const glm::vec3& a, const glm::vec3& b,
                       const glm::dvec3& p);

/// Sign of s n.(p - a) - threshold with n = (b - a) x (c - a), s = +1 or -1.
int plane_excess(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::dvec3& p, int s,
                 double threshold);

/// Sign of n.(p - a), n as above: > 0 in front of the triangle (the side from which it is counter-clockwise).
int point_side(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& p);
/// Sign of n.direction.
int direction_side(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& direction);

}  // namespace tenebra::math
