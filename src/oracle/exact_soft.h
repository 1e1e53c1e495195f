// The oracle of the soft shadows: the part of an area light that a point sees, by the definition in
// tenebra/soft_shadows.h. Lines and signs are exact; the area of the visible part is found by a sweep over
// the light's polygon, in rationals or in long doubles with a bound of the error. Shares no code with
// src/soft.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/area_light.h>
#include "oracle/slab_difference.h"
#include "oracle/triangle_boxes.h"

namespace tenebra::oracle {

enum class SweepNumbers {
  rational,    ///< exact up to the rounding of the sum; some ms per point with ten occluders
  long_double  ///< error within SoftAnswer::error_bound
};

/// A part of the visible region in the light's frame: left <= u <= right between two straight lines.
struct Trapezoid {
  long double left, right;
  long double low_left, low_right, high_left, high_right;
};

struct SoftAnswer {
  double visible_fraction = 0;
  double irradiance = 0;   ///< for radiance 1; error below 1e-9 where the light is seen from less than 1e5
                           ///< times its size away
  double unoccluded = 0;   ///< irradiance of the light's part above the horizon
  double error_bound = 0;  ///< of visible_fraction
  bool at_plane = false;   ///< ex x ey and `normal` put the point on different sides of the light's plane
  bool skipped = false;    ///< too many occluders: nothing but their number is known
  std::size_t candidates = 0;  ///< triangles in the shaft
  std::size_t occluders = 0;   ///< of these, those that block a part of the light above the horizon
  std::vector<Trapezoid> visible;
};

class ExactSoft {
public:
  /// Keeps references to what `triangles` refers to. The light's points are centre + u ex + v ey, (u, v) in
  /// its outline, in exact numbers; it shines to the side of ex x ey. A sun's are directions.
  ExactSoft(const ViewRays& view, const TriangleView& triangles, const AreaLight& light);

  /// What the sample (a point, its triangle, a shading normal; zero: the face normal towards the view) sees.
  /// The time grows with the square of the occluders: beyond `most_occluders` the point is skipped.
  SoftAnswer answer(const glm::dvec3& point, std::uint32_t id, const glm::vec3& normal = glm::vec3(0),
                    SweepNumbers numbers = SweepNumbers::long_double,
                    std::size_t most_occluders = 100000) const;
  /// Triangles that may block the sample: conservative.
  std::vector<std::uint32_t> candidates(const glm::dvec3& point, std::uint32_t id) const;
  /// How far the light is off, in lengths of its longest axis; of a sun one over its radius in radians.
  double distance_in_sizes(const glm::dvec3& point) const;

private:
  template <class N>
  SoftAnswer solve(const glm::dvec3& point, std::uint32_t id, glm::vec3 normal, std::size_t most) const;
  int eye_side(std::uint32_t id) const;
  int light_side(const glm::dvec3& point) const;

  ViewRays view_;
  TriangleView triangles_;
  AreaLight light_;
  TriangleBoxes boxes_;
};

/// -1/2 sum of angle times normal over the edges of a planar polygon around the origin's view (Lambert's
/// formula): positive for one that runs counter-clockwise seen from the origin. All of it must lie above the
/// plane of `normal`.
struct Vector3l {
  long double x, y, z;
};
long double polygon_irradiance(const std::vector<Vector3l>& polygon, const Vector3l& normal);

}  // namespace tenebra::oracle
