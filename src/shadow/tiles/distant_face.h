// A seventh face beside those of the cube, for rays that are parallel or nearly so: of directional lights,
// and of lights that are far from all points.
//
// A cube around a light that is 10^9 m away shows the whole scene in one spot of one face, and differences of
// floats there are metres wide. So positions are taken relative to a point amid the rays instead, and rays
// are told apart by where they lie across the light's direction. With z along the axis on which the light l
// (relative to the origin, or its direction) lies farthest, towards the light, a point (x, y, z) has
//
//   u = (x - S z) / q,   v = (y - T z) / q,   w = z / q,      q = 1 - K z,  S = l.x / l.z,  T = l.y / l.z,
//
// where K = 1 / l.z, and 0 for directional lights. A point moved towards the light, p + t (l - p), has 1 - t
// times the numerators and the q of p: u and v are the same all along a ray, and w grows. Rays are points of
// (u, v) again, triangles before the light (q > 0) are triangles, and of all that lies on a ray the nearer to
// the light has the larger w: all as on the cube. Planes through the light do not depend on w at all.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include <tenebra/hard_config.h>
#include "points/point_tiles.h"
#include "shadow/decision/triangle_planes.h"

namespace tenebra::shadow {

inline constexpr std::uint8_t distant_face_number = 6;  ///< after those of the cube

struct DistantFace {
  glm::vec3 origin{0.0f};     ///< exact
  int axes[3] = {0, 1, 2};    ///< of u, v and z
  float sign = 1;             ///< of z along its axis: towards the light
  double slope[2] = {0, 0};   ///< S, T, at most 1; off by 2^-50 of themselves
  double approach = 0;        ///< K, as above
  float s = 0, t = 0, k = 0;  ///< the same in float
  float extent = 0;           ///< >= |coordinate| of all points; |K z| <= 1/16 there
  float across = 0;           ///< >= |u| + |v| of all points
  float along = 0;            ///< >= |w| of all points
  float per_extent = 0;       ///< about 1 / extent

  /// u, v and w of a point relative to the origin.
  glm::dvec3 place(const glm::dvec3& p) const;
};

/// For directional lights, and others that are at least 16 times as far as the points extend. None, too,
/// where points are 10^15 m and more apart.
std::optional<DistantFace> distant_face(const ShadowLight& light, const points::PointTiles& tiles);

/// The light with positions relative to the face's origin.
RaySource distant_source(const RaySource& source, const DistantFace& face);

}  // namespace tenebra::shadow
