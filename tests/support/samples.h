// Samples for the tests of visibility: views through a pinhole, and points chosen to hurt.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ao/reference/embree.h"
#include "support/soup.h"

namespace tenebra::testing {

/// Embree over a soup: plausible triangle ids, and the peer of the comparisons. Robust flag set.
class PeerTracer {
public:
  explicit PeerTracer(const TriangleView& triangles);
  ~PeerTracer();
  PeerTracer(const PeerTracer&) = delete;
  PeerTracer& operator=(const PeerTracer&) = delete;

  std::uint32_t nearest(glm::vec3 origin, glm::vec3 direction, float from = 0) const;
  bool occluded(glm::vec3 origin, glm::vec3 direction, float from, float to) const;
  /// What each pixel of the view sees.
  std::vector<std::uint32_t> ids(const ViewRays& view, int width, int height) const;

private:
  RTCDevice device_;
  RTCScene scene_;
};

/// Perspective rays of a camera at `eye` that looks at `target`; `fov` is the tangent of half the vertical
/// angle.
ViewRays pinhole(glm::dvec3 eye, glm::dvec3 target, double fov, int width, int height);

/// Points of `view` with the ids that the peer sees (by compute_visible_points).
VisiblePoints view_samples(const TriangleView& triangles, const ViewRays& view, int width, int height);

/// `count` points (laid out as a square) on random triangles: somewhere inside, on edges, on vertices.
VisiblePoints points_on_triangles(const Soup& soup, Random& random, int count);

/// `count` points (laid out as a square) that lie where the light's ray through a vertex or a point of an
/// edge goes on to meet another triangle: every one of them is a close call.
VisiblePoints points_behind_edges(const Soup& soup, const ShadowLight& light, Random& random, int count);

/// The same samples, on the sides of their triangles that `view` sees.
inline VisiblePoints seen_from(VisiblePoints points, const ViewRays& view) {
  points.seen_from = view;
  return points;
}

/// A view for which every point is active that can be: the eye is at the light.
ViewRays view_from_light(const ShadowLight& light);

}  // namespace tenebra::testing
