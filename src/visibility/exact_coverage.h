// Whether the ray through a pixel's centre meets a triangle, exactly. Internal to visibility.
#pragma once

#include <glm/glm.hpp>

#include <tenebra/frame_geometry.h>
#include "visibility/window.h"

namespace tenebra::visibility {

/// All answers are those of real arithmetic on the floats of view and vertices.
class ExactCoverage {
public:
  ExactCoverage(const ViewRays& view, const Window& window) : view_(view), window_(window) {}

  /// Sign of det(a - eye, b - eye, c - eye); orthographic: of det(d0, b - a, c - a). 0: seen edge-on.
  int facing(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) const;
  /// Whether the triangle, its edges included, is met by the ray through a place of the window, a multiple of
  /// 1/512 pixels: before the eye; orthographic: by the whole line. Edge-on triangles are met by none.
  bool meets(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::dvec2& place) const;

private:
  int edge_sign(const glm::vec3& a, const glm::vec3& b, const glm::dvec2& place) const;
  int exact_edge_sign(const glm::vec3& a, const glm::vec3& b, const glm::dvec2& place) const;

  const ViewRays& view_;
  const Window& window_;
};

}  // namespace tenebra::visibility
