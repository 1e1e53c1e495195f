// A camera's matrices as rays, and points from depths.
#include <tenebra/host_frame.h>

#include <cmath>
#include <limits>

#include "base/fail.h"

namespace tenebra {
namespace {

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool has_inverse(const glm::dmat3& m) {
  const double determinant = glm::determinant(m);
  return std::isfinite(determinant) && std::isfinite(1.0 / determinant);
}

/// A row of a matrix: what makes one coordinate of points (x, y, z, 1).
glm::dvec4 row_of(const glm::dmat4& m, int row) {
  return {m[0][row], m[1][row], m[2][row], m[3][row]};
}

}  // namespace

// With rows X, Y, W of the matrix a point p is at window coordinates (x, y) if X.p = x W.p and Y.p = y W.p.
// In perspective X.e = Y.e = W.e = 0 at the eye e, and p - e is a multiple of A^-1 (x, y, 1), A the three
// rows' first three columns. In parallel views W is constant, and all p - e have the direction that the
// camera looks.
Expected<ViewRays> host_view(const HostCamera& camera, int width, int height) {
  if (width < 1 || height < 1)
    return base::fail("host's camera: found a picture of {}x{}, expected at least 1x1", width, height);
  const glm::dmat4 clip_from_world = camera.clip_from_view * camera.view_from_world;
  const glm::dvec4 x = row_of(clip_from_world, 0), y = row_of(clip_from_world, 1),
                   w = row_of(clip_from_world, 3);
  const glm::dvec4 along = -row_of(camera.view_from_world, 2);
  const bool parallel = glm::dvec3(w) == glm::dvec3(0.0);
  const glm::dvec4 third = parallel ? along : w;
  const glm::dmat3 rows = glm::transpose(glm::dmat3(glm::dvec3(x), glm::dvec3(y), glm::dvec3(third)));
  if (!has_inverse(rows) || (parallel && !(std::abs(w.w) > 0)))
    return base::fail("host's camera: found matrices that span no picture");
  const glm::dmat3 inverse = glm::inverse(rows);
  const double step_x = 2.0 / width, step_y = -2.0 / height;  // row 0 is at the top, where y is 1
  ViewRays view;
  view.orthographic = parallel;
  const double scale = parallel ? w.w : 1.0;
  const glm::dvec3 corner = inverse * (scale * glm::dvec3(-1.0, 1.0, parallel ? 0.0 : 1.0));
  const glm::dvec3 origin = inverse * -glm::dvec3(x.w, y.w, third.w);
  view.eye = glm::vec3(parallel ? origin + corner : origin);
  view.d0 = glm::vec3(parallel ? glm::normalize(inverse[2]) : corner);
  view.dx = glm::vec3(inverse[0] * (scale * step_x));
  view.dy = glm::vec3(inverse[1] * (scale * step_y));
  if (!is_finite(view.eye) || !is_finite(view.d0) || !is_finite(view.dx) || !is_finite(view.dy))
    return base::fail("host's camera: found rays that are not finite");
  return view;
}

Expected<void> positions_from_depth(const HostFrame& frame, const HostCamera& camera, double far_depth,
                                    std::vector<glm::dvec3>& positions) {
  if (frame.width < 1 || frame.height < 1)
    return base::fail("host's frame: found size {}x{}, expected at least 1x1", frame.width, frame.height);
  const std::size_t pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  if (frame.depth.size() != pixels)
    return base::fail("host's frame: found {} depths, expected {}x{}", frame.depth.size(), frame.width,
                      frame.height);
  const glm::dmat4 clip_from_world = camera.clip_from_view * camera.view_from_world;
  const double determinant = glm::determinant(clip_from_world);
  if (!std::isfinite(determinant) || !std::isfinite(1.0 / determinant))
    return base::fail("host's camera: found matrices that have no inverse");
  const glm::dmat4 world_from_clip = glm::inverse(clip_from_world);
  positions.assign(pixels, glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
  for (std::size_t i = 0; i < pixels; ++i) {
    const double depth = frame.depth[i];
    if (depth == far_depth) continue;
    const auto width = static_cast<std::size_t>(frame.width);
    const double x = 2 * (static_cast<double>(i % width) + 0.5) / frame.width - 1;
    const double y = 1 - 2 * (static_cast<double>(i / width) + 0.5) / frame.height;
    const glm::dvec4 at =
        world_from_clip * glm::dvec4(x, y, camera.depth_zero_to_one ? depth : 2 * depth - 1, 1.0);
    positions[i] = glm::dvec3(at) / at.w;
  }
  return {};
}

}  // namespace tenebra
