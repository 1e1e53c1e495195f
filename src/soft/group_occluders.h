// The occluders of one group of points as the solvers use them: lines on the light's plane that move linearly
// with the point. Set up in double relative to the group's centre, then kept in T: this is what makes single
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

/// Line (u, v, w) at P = centre + d: c[0] + d.x c[1] + d.y c[2] + d.z c[3]; c[k] = {u, v, w, 0}.
template <class T>
struct MovingLine {
  T c[4][4];
};

/// The plane through the group's points and an edge in space, relative to the group's centre: the side of a
/// place v for the point d is normal.(v - a) - d.(along x (v - a)), positive inside the occluder.
struct EdgePlane {
  glm::dvec3 a{0.0};
  glm::dvec3 along{0.0};   ///< from a to b, signed; 0: no edge, but the occluder's own plane
  glm::dvec3 normal{0.0};  ///< at the centre
};

/// A triangle whose shadow on the light's plane is, for every point of the group, where all its lines are
/// positive. Lines that are positive for every point and all of the light are left out.
struct Occluder {
  std::uint32_t triangle = 0;
  std::uint32_t first_line = 0;
  std::uint32_t line_count = 0;  ///< 0: the light is dark for the whole group
  double size = 0;               ///< about the solid angle at the group's centre
};

template <class T>
struct GroupOccluders {
  std::vector<Occluder> occluders;  ///< largest first (ties: by id)
  std::vector<MovingLine<T>> lines;
  std::vector<EdgePlane> planes;          ///< one a line
  std::vector<std::uint32_t> indefinite;  ///< triangles that shadow the points from both sides, some of them
                                          ///< not at all, or carry some: to be asked point by point
  double condition = 0;  ///< largest factor by which lines amplify rounding: a line lies within
                         ///< 4 epsilon(T) condition of its place, units of the light
};

/// Sorts `candidates` into definite and indefinite occluders and sets up their lines. What it leaves out
/// blocks nothing between the group and the light (Theorem 1, with margins for the rounding of double).
template <class T>
void set_up_occluders(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                      std::span<const std::uint32_t> candidates, GroupOccluders<T>& out);

/// The lines of one occluder at one point, in double: its shadow is where all are positive. Returns their
/// number, 0 if the triangle does not block from there (contact rule; `receiver`: the point's triangle).
int occluder_lines_at(const LightFrame& light, const TriangleView& triangles, std::uint32_t occluder,
                      const glm::dvec3& point, std::uint32_t receiver, double receiver_tau,
                      glm::dvec3 lines[4]);

/// The line on the light's plane where triangle `receiver` meets it, positive on the side of `seen_side`
/// (+1: that of the triangle's normal).
glm::dvec3 horizon_line(const LightFrame& light, const TriangleView& triangles, std::uint32_t receiver,
                        int seen_side);

}  // namespace tenebra
