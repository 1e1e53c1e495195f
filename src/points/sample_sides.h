// On which sides of their triangles samples are, and the view that some were seen from.
#pragma once

#include <cstddef>
#include <cstdint>

#include <tenebra/visible_points.h>
#include "points/triangle_corners.h"

namespace tenebra::points {

/// The view that samples were seen from, for what makes and completes them.
struct ViewOfSamples {
  static const ViewRays* of(const SeenFrom& from) { return from.view_ ? &*from.view_ : nullptr; }
  /// Of samples whose view is needed; another one if they have none.
  static ViewRays or_any(const SeenFrom& from) { return from.view_.value_or(ViewRays{}); }
};

/// Sides one by one, as visible_side(): quick where neighbours lie on one triangle. One for each thread.
class SideFinder {
public:
  SideFinder(const VisiblePoints& points, const TriangleView& triangles)
      : points_(points), triangles_(triangles), view_(ViewOfSamples::of(points.seen_from)) {}

  /// Samples on one triangle may be on different sides of it; else all are on one.
  bool differ() const { return !points_.sides.empty(); }
  int at(std::size_t sample) {
    if (!points_.sides.empty()) return points_.sides[sample];
    if (points_.triangles[sample] == id_) return side_;
    id_ = points_.triangles[sample];
    const bool seen = view_ != nullptr && id_ < triangles_.triangles.size();
    return side_ = seen ? eye_side(corners_of(triangles_, id_).v, *view_) : 0;
  }

private:
  const VisiblePoints& points_;
  const TriangleView& triangles_;
  const ViewRays* view_;
  std::uint32_t id_ = no_triangle;
  int side_ = 0;
};

/// Whether samples were seen within three pixels of each other: neighbours in a list may not be. Of samples
/// that were seen from no view nothing is known, and the answer is yes.
class SeenTogether {
public:
  explicit SeenTogether(const SeenFrom& from);
  bool operator()(const glm::dvec3& a, const glm::dvec3& b) const;

private:
  bool known_ = false, orthographic_ = false;
  glm::dvec3 eye_{0.0}, d0_{0.0};
  double most_ = 0;  ///< square of the angle (orthographic: of the distance)
};

}  // namespace tenebra::points
