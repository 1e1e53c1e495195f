#include "visibility/window.h"

#include <algorithm>
#include <cmath>

namespace tenebra::visibility {
namespace {

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

}  // namespace

// Each of x_row.q, y_row.q and t_row.q is off by at most 6 u |row| |q| (largest and L1 norm: two products
// deep, two sums, and q rounded), so that in perspective x = x_row.q / t is off by
// 6 u |q| / t (|x_row| + x |t_row|), with t >= 2^-20 |t_row| |q| below 2^-30 (|x_row| / |t_row| + x). In
// orthographic views |x_row| |q| <= 2^40 bounds it by 2^-10. Floats add 2^-24 x, which is 2^-9 at the edge of
// the largest window, 2^15 pixels, and the two sums with `margin` as much again each.
Window::Window(const ViewRays& view, const ClipTransform& transform, int width, int height)
    : eye(view.eye),
      d0(view.d0),
      dx(view.dx),
      dy(view.dy),
      orthographic(view.orthographic),
      width(width),
      height(height),
      near_t(static_cast<double>(transform.near_t)),
      far_t(static_cast<double>(transform.far_t)) {
  const glm::dvec3 axis = glm::cross(dx, dy);
  const double volume = glm::dot(d0, axis);
  t_row = axis / volume;
  x_row = glm::cross(dy, d0) / volume;
  y_row = glm::cross(d0, dx) / volume;
  const double across = std::max(largest(glm::abs(x_row)), largest(glm::abs(y_row)));
  const double along = largest(glm::abs(t_row));
  least_slope = std::ldexp(along, -20);
  const glm::dvec3 span =
      static_cast<double>(width) * glm::abs(dx) + static_cast<double>(height) * glm::abs(dy);
  if (orthographic) {
    farthest = std::ldexp(1.0, 40) / across;
    margin = std::ldexp(1.0f, -6);
    reach = largest(glm::abs(d0));
    shift = span.x + span.y + span.z;
  } else {
    margin = static_cast<float>(std::ldexp(1.0, -6) + std::ldexp(across / along, -29));
    reach = largest(glm::abs(d0) + span);
  }
}

}  // namespace tenebra::visibility
