// Lines in Pluecker coordinates: side operator, dual hyperplanes, and the orientation of all lines between
// two convex sets. Mora, Aveneau, Apostu and Ghazanfarpour 2012, sections 3.1 to 3.3.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace tenebra::math {

/// An oriented line: six homogeneous coordinates. As a hyperplane it holds the lines that meet it:
/// side(hyperplane, line) = 0.
struct PluckerLine {
  glm::dvec3 direction{0.0};  ///< Q - P
  glm::dvec3 moment{0.0};     ///< P x Q
};

/// The line from p to q, in double: coordinates of the direction are rounded once, those of the moment are
/// off by at most 2^-52 |p|_1 |q|_1.
PluckerLine line_through(const glm::dvec3& p, const glm::dvec3& q);

/// The side operator, up to rounding: > 0, < 0 by the way in which the lines pass each other, 0 where they
/// meet or are parallel. Symmetric; linear in either line, so a hyperplane test is one product of six.
double side(const PluckerLine& a, const PluckerLine& b);

/// Sign of side(line_through(p, q), line_through(a, b)), exact: a triangle's line from p to q passes to the
/// outer side of an edge a-b where the signs of the edges differ. Zero if the four points lie in one plane.
int side_sign(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b);

enum class Orientation { negative, mixed, positive };

/// Theorem 1: how the lines from the hull of `from` to the hull of `to` pass the line a-b. The side operator
/// is affine in p and in q, so the lines between vertices decide for all. `positive` and `negative` are
/// certain (by the exact sign) and strict; `mixed`: both signs, or zero, occur among the vertices' lines.
Orientation orientation(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to, const glm::dvec3& a,
                        const glm::dvec3& b);

}  // namespace tenebra::math
