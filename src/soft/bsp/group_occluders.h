// The occluders of one group of points as the BSP uses them: lines on the light's plane that move linearly
// with the point. For a point P and an edge from a to b, the plane through the three has the normal n = (a-P)
// x (b-a). On which side of it a place Q = origin + u ex + v ey of the light's plane lies is told by the sign
// of
//   n.(Q-P) = (n.ex) u + (n.ey) v + n.(origin-P),
// whose coefficients are affine in P. Relative to the group's centre and in double.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "soft/occluders/group_candidates.h"

namespace tenebra::soft {

/// Line (u, v, w) at P = centre + d: c[0] + d.x c[1] + d.y c[2] + d.z c[3]. Scaled so that no coefficient of
/// any point of the group exceeds 1.
struct MovingLine {
  glm::dvec3 c[4];
};

/// The plane through a point of the group and an edge in space, relative to the group's centre: the side of a
/// place v for the point d is normal.(v - a) - d.(along x (v - a)), positive inside the occluder.
struct EdgePlane {
  glm::dvec3 a{0.0};
  glm::dvec3 along{0.0};   ///< from a to b, signed; 0: no edge, but the occluder's own plane
  glm::dvec3 normal{0.0};  ///< at the centre
};

/// Occluders come in classes of size, largest first, and within a class in the order of the triangles:
/// neighbours of a mesh then follow each other and remove the light from one side, where an order by size
/// alone would riddle it with holes.
inline bool comes_before(int size_a, std::uint32_t triangle_a, int size_b, std::uint32_t triangle_b) {
  return size_a != size_b ? size_a > size_b : triangle_a < triangle_b;
}

/// A triangle whose shadow on the light's plane is where all its lines are positive.
struct Occluder {
  std::uint32_t triangle = 0;
  std::uint32_t first_line = 0;
  std::uint32_t line_count = 0;  ///< 0: the light is dark for the whole group
  int size = 0;                  ///< class of the solid angle at the group's centre, as in Candidate
};

/// What the BSP is made of.
struct GroupOccluders {
  /// Triangles that shadow all points of the group from the same side, largest first (ties: by id). Lines
  /// that are positive for every point and all of the light are left out.
  std::vector<Occluder> occluders;
  /// Triangles with points on both sides, or too near, or on the triangle itself: places in
  /// GroupCandidates::all.
  std::vector<std::uint32_t> indefinite;
  std::vector<MovingLine> lines;
  std::vector<EdgePlane> planes;  ///< one for each line

  static constexpr std::size_t most_lines = 4;  ///< of an occluder
};

/// Sorts `candidates` into definite and indefinite occluders and sets up the lines of the former. Candidates
/// that it leaves out block nothing between the group and the light (Theorem 1, with margins for the rounding
/// of double).
void set_up_occluders(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                      const GroupCandidates& candidates, GroupOccluders& out);

}  // namespace tenebra::soft
