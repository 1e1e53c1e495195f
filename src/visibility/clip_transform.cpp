#include "visibility/clip_transform.h"

#include "base/fail.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenebra::visibility {
namespace {

/// t of the far plane of an orthographic view: just behind the corner of the box that is farthest along d0.
double far_parameter(const ViewRays& view, const math::Box<float>& bounds, const glm::dvec3& t_row,
                     double near_t) {
  double far_t = near_t;
  if (!bounds.empty()) {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p((corner & 1) ? bounds.high.x : bounds.low.x,
                         (corner & 2) ? bounds.high.y : bounds.low.y,
                         (corner & 4) ? bounds.high.z : bounds.low.z);
      far_t = std::max(far_t, glm::dot(t_row, p - glm::dvec3(view.eye)));
    }
  }
  // A margin for the rounding of clip coordinates; never zero, or a flat scene at the near plane would have
  // no depth.
  return far_t + 1e-3 * std::max(far_t - near_t, 1e-3 * std::abs(near_t) + 1e-30);
}

}  // namespace

math::Box<float> bounds_of(std::span<const glm::vec3> positions) {
  math::Box<float> box;
  for (const glm::vec3& p : positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    box.add(p);
  }
  return box;
}

Expected<ClipTransform> clip_transform(const ViewRays& view, const math::Box<float>& bounds, int width,
                                       int height) {
  const glm::dvec3 d0(view.d0), dx(view.dx), dy(view.dy);
  const glm::dvec3 axis = glm::cross(dx, dy);
  const double volume = glm::dot(d0, axis);
  const double depth = std::abs(volume) / glm::length(axis);  // of the plane t = 1, along the view's axis
  const double near_t = view.near_m / depth;
  if (!std::isfinite(near_t) || !std::isfinite(1.0 / volume) ||
      !(view.orthographic ? near_t >= 0 : near_t > 0) ||
      !std::isfinite(glm::dot(glm::dvec3(view.eye), glm::dvec3(view.eye)))) {
    return base::fail(
        "camera: found rays that span no picture, expected finite width, height, depth and near plane");
  }
  // q = t d0 + a dx + b dy by Cramer's rule; in perspective a = t X, b = t Y of the window position (X, Y).
  const glm::dvec3 t_row = axis / volume;
  const glm::dvec3 a_row = glm::cross(dy, d0) / volume * (2.0 / width);
  const glm::dvec3 b_row = glm::cross(d0, dx) / volume * (2.0 / height);
  ClipTransform result;
  result.near_t = static_cast<float>(near_t);
  glm::dmat4x3 rows(0.0);  // rows of clip_from_offset
  if (view.orthographic) {
    const double far_t = far_parameter(view, bounds, t_row, near_t);
    result.far_t = static_cast<float>(far_t);
    rows = glm::dmat4x3(a_row, b_row, -t_row / (far_t - near_t), glm::dvec3(0.0));
    result.clip_offset = glm::dvec4(-1.0, -1.0, far_t / (far_t - near_t), 1.0);
  } else {
    rows = glm::dmat4x3(a_row - t_row, b_row - t_row, glm::dvec3(0.0), t_row);
    result.clip_offset = glm::dvec4(0.0, 0.0, near_t, 0.0);
  }
  result.clip_from_offset = glm::transpose(rows);
  return result;
}

glm::dvec3 point_from_depth(const ViewRays& view, const ClipTransform& transform, int x, int y, float depth) {
  const glm::dvec3 across = (x + 0.5) * glm::dvec3(view.dx) + (y + 0.5) * glm::dvec3(view.dy);
  const double near_t = transform.near_t, far_t = transform.far_t;
  if (view.orthographic) {
    return glm::dvec3(view.eye) + across + (far_t + depth * (near_t - far_t)) * glm::dvec3(view.d0);
  }
  return glm::dvec3(view.eye) + near_t / depth * (glm::dvec3(view.d0) + across);
}

}  // namespace tenebra::visibility
