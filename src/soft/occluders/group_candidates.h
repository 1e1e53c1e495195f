// The triangles that may stand between one group of points and the light, in axes of the light around the
// group's centre. All that the solvers ask of a triangle at a point follows from its corners there:
//
// For a point P and an edge from a to b, the plane through the three has the normal N = (a-P) x (b-a), and
// the sign of N.(Q-P) says on which side of it a place Q of the light's plane lies: a line on the light's
// plane (the hyperplane of the edge in Pluecker space, met with the lines through P; Mora et al. 2012,
// section 4.2). Coordinates relative to the group and in double are what makes polygons in single precision
// work with far lights.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/simd_level.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include "soft/light/light_frame.h"
#include "soft/occluders/group_frame.h"

namespace tenebra::soft {

/// Rounding of sums of products in double, relative to the sum of their magnitudes: fewer than 16 operations
/// on inputs that carry one rounding each.
inline constexpr double product_rounding = 0x1p-48;

/// Axes of the light around a place: the light's unit is the unit of all three coordinates, the third is the
/// height towards the light's plane; for a sun, that is a plane at one height above every point. An affine
/// map: it keeps lines, planes and sides (times `turn`).
struct LightAxes {
  glm::dvec3 u{0.0}, v{0.0}, height{0.0};  ///< rows of the map from world space
  glm::dvec3 centre{0.0};                  ///< world space; the origin of these axes
  /// Its u and v from the light's origin, and the height of the light's plane over it.
  glm::dvec3 centre_uv{0.0};
  double turn = 1;    ///< sign of the map's determinant
  double weight = 1;  ///< the light's: a point's u and v from its origin are centre_uv plus weight times the
                      ///< point's, the height of its plane over the point is centre_uv.z less weight times z

  /// A difference from the centre in these axes.
  glm::dvec3 of(const glm::dvec3& from_centre) const {
    return {glm::dot(u, from_centre), glm::dot(v, from_centre), glm::dot(height, from_centre)};
  }
  /// Half the sizes, in these axes, of the box around a box with the half sizes `half` in world space.
  glm::dvec3 half_around(const glm::dvec3& half) const {
    return {glm::dot(glm::abs(u), half), glm::dot(glm::abs(v), half), glm::dot(glm::abs(height), half)};
  }
};
LightAxes light_axes(const LightFrame& light, const glm::dvec3& centre);

/// Where the points of a group lie relative to the plane of a triangle: at centre + d the height over it,
/// times the length of its normal, is height + d.slope.
struct PlaneHeight {
  double height = 0;
  glm::dvec3 slope{0.0};  ///< the triangle's normal n
  double threshold = 0;   ///< tau |n|, tau the triangle's rounding tolerance
  double length = 0;      ///< |n|
};

/// +1: the occluder blocks the point centre + d by its lines as they are; -1: with their signs turned; 0: not
/// at all (contact rule).
inline int blocking_sign(const PlaneHeight& plane, const glm::dvec3& d, double receiver_tau) {
  const double height = plane.height + d.x * plane.slope.x + d.y * plane.slope.y + d.z * plane.slope.z;
  const double threshold = plane.threshold + receiver_tau * plane.length;
  return height < -threshold ? 1 : height > threshold ? -1 : 0;
}

/// blocking_sign() where it is the same for all points of `group`, `centre` + d each; 0 where it might not
/// be.
int certain_sign(const PlaneHeight& plane, const glm::dvec3& centre, const GroupFrame& group);

/// A triangle that may block, or two that are seen as one quadrilateral (quads.h).
struct Candidate {
  double corners[4][3];  ///< corner, coordinate in LightAxes; a triangle's fourth is its first
  double plane[3];  ///< (u, v, w) of the triangle's own plane; times `sign` positive everywhere if not needed
  /// +-1: its lines times this are positive in its shadow, at all points; 0: see PlaneHeight.
  double sign = 0;
  std::uint32_t triangle = 0;
  /// Class of the solid angle at the group's centre: the binary logarithm, rounded down, of about twice the
  /// angle. For a quad approximately.
  std::int32_t size = 0;
  std::uint32_t height = 0;  ///< index into GroupCandidates::heights where sign is 0
  std::uint32_t second = 0;  ///< place of a quad's second triangle in GroupCandidates::all
  bool has_plane = false;
  bool is_quad = false;
  /// Well apart from all points and the light's plane: its shadow there is finite.
  bool stands_between = false;
};

struct GroupCandidates {
  LightAxes axes;
  std::vector<Candidate> all;
  std::vector<PlaneHeight> heights;

  void clear() {
    all.clear();
    heights.clear();
  }
};

/// Fills `out` with those of the triangles `ids` that may block between the group's points and the light, in
/// their order. What it leaves out blocks nothing there (margins cover the rounding of double). Of no use if
/// `stop` was requested.
using FindCandidates = void (*)(const LightFrame& light, const TriangleView& triangles,
                                const GroupFrame& group, std::span<const std::uint32_t> ids,
                                GroupCandidates& out, const StopFlag* stop);
FindCandidates find_candidates_kernel(SimdLevel level);

}  // namespace tenebra::soft
