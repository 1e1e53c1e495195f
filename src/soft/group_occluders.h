// The occluders of one group of points as the solvers use them: lines on the light's plane that move linearly
// with the point. Relative to the group's centre and in double: this is what makes polygons in single
// precision work with far lights.
//
// For a point P and an edge from a to b of an occluder, the plane through P, a, b has the normal
// n = (a-P) x (b-a), and a point Q = origin + u ex + v ey of the light's plane lies on its side
//   n.(Q-P) = (n.ex) u + (n.ey) v + n.(origin-P):
// a line on the light's plane (the hyperplane of the edge in Pluecker space, met with the lines through P;
// Mora et al. 2012, section 4.2). All three coefficients are affine in P.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "points/visible_points.h"
#include "soft/light_frame.h"

namespace tenebra {

/// What the points of a group share. World space.
struct GroupFrame {
  glm::dvec3 centre{0.0}, half{0.0};         ///< box of the points
  std::span<const std::uint32_t> receivers;  ///< triangles that the points lie on
  double receiver_tau = 0;                   ///< largest rounding tolerance of these
};

/// Line (u, v, w) at P = centre + d: c[0] + d.x c[1] + d.y c[2] + d.z c[3]. Scaled so that no coefficient of
/// any point of the group exceeds 1.
struct MovingLine {
  glm::dvec3 c[4];
};

/// The plane through the group's points and an edge in space, relative to the group's centre: the side of a
/// place v for the point d is normal.(v - a) - d.(along x (v - a)), positive inside the occluder.
struct EdgePlane {
  glm::dvec3 a{0.0};
  glm::dvec3 along{0.0};   ///< from a to b, signed; 0: no edge, but the occluder's own plane
  glm::dvec3 normal{0.0};  ///< at the centre
};

/// Occluders come in classes of size, largest first, and within a class in the order of the triangles:
/// neighbours of a mesh then follow each other and eat up the light from one side, where an order of size
/// alone riddles it with holes.
inline bool comes_before(int size_a, std::uint32_t triangle_a, int size_b, std::uint32_t triangle_b) {
  return size_a != size_b ? size_a > size_b : triangle_a < triangle_b;
}

/// A triangle whose shadow on the light's plane is where all its lines are positive.
struct Occluder {
  std::uint32_t triangle = 0;
  std::uint32_t first_line = 0;
  std::uint32_t line_count = 0;  ///< 0: the light is dark for the whole group
  int size = 0;  ///< class of the solid angle at the group's centre: its binary logarithm, rounded down
};

/// Where the points of a group lie to the plane of a triangle: at centre + d the height over it, times the
/// length of its normal, is height + d.slope.
struct PlaneHeight {
  double height = 0;
  glm::dvec3 slope{0.0};  ///< the triangle's normal n
  double threshold = 0;   ///< tau |n|, tau the triangle's rounding tolerance
  double length = 0;      ///< |n|
};

/// What the BSP is made of.
struct GroupOccluders {
  /// Triangles that shadow all points of the group from the same side, largest first (ties: by id). Lines
  /// that are positive for every point and all of the light are left out.
  std::vector<Occluder> occluders;
  /// Triangles with points on both sides, or too near, or on the triangle itself.
  std::vector<std::uint32_t> indefinite;
  std::vector<MovingLine> lines;
  std::vector<EdgePlane> planes;  ///< one a line
};

/// Sorts `candidates` into definite and indefinite occluders and sets up their lines. What it leaves out
/// blocks nothing between the group and the light (Theorem 1, with margins for the rounding of double).
void set_up_occluders(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                      std::span<const std::uint32_t> candidates, GroupOccluders& out);

/// +1: the occluder blocks points like centre + d by its lines as they are; -1: with their signs turned; 0:
/// not at all (contact rule).
inline int blocking_sign(const PlaneHeight& plane, const glm::dvec3& d, double receiver_tau) {
  const double height = plane.height + d.x * plane.slope.x + d.y * plane.slope.y + d.z * plane.slope.z;
  const double threshold = plane.threshold + receiver_tau * plane.length;
  return height < -threshold ? 1 : height > threshold ? -1 : 0;
}

/// The line on the light's plane where triangle `receiver` meets it, positive on the side of `seen_side`
/// (+1: that of the triangle's normal).
glm::dvec3 horizon_line(const LightFrame& light, const TriangleView& triangles, std::uint32_t receiver,
                        int seen_side);

}  // namespace tenebra
