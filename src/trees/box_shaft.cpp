#include "trees/box_shaft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenebra::trees {
namespace {

/// The line that touches two rectangles from the side (`si`, `sj`), if there is one. Its normal is off by at
/// most 2^-52 of the coordinates, and places in the hull are off by at most that times the hull's size: the
/// limit is wider than this and the rounding of its own sums by far.
bool touching_line(const math::Box<double>& a, const math::Box<double>& b, int i, int j, int si, int sj,
                   double reach, BoxShaft::Plane& out) {
  const auto corner = [](const math::Box<double>& box, int axis, int s) {
    return s > 0 ? box.high[axis] : box.low[axis];
  };
  const double ai = corner(a, i, si), aj = corner(a, j, sj);
  const double di = corner(b, i, si) - ai, dj = corner(b, j, sj) - aj;
  double m = dj, n = -di;
  if (m * si < 0 || n * sj < 0) m = -m, n = -n;
  if (m * si < 0 || n * sj < 0 || (m == 0 && n == 0)) return false;
  const double size = std::abs(m) + std::abs(n);
  m /= size, n /= size;
  const double extent = std::max(a.high[i], b.high[i]) - std::min(a.low[i], b.low[i]) +
                        std::max(a.high[j], b.high[j]) - std::min(a.low[j], b.low[j]);
  out = {i, j, m, n, m * ai + n * aj + 0x1p-45 * reach * (1 + extent / size)};
  return std::isfinite(out.limit);
}

}  // namespace

BoxShaft shaft_between(const math::Box<double>& a, const math::Box<double>& b) {
  BoxShaft shaft;
  const glm::dvec3 low = glm::min(a.low, b.low), high = glm::max(a.high, b.high);
  const glm::dvec3 most = glm::max(glm::abs(low), glm::abs(high));
  shaft.box = {low, high};
  const double reach = std::max({most.x, most.y, most.z});
  for (int i = 0; i < 2; ++i)
    for (int j = i + 1; j < 3; ++j)
      for (const int si : {-1, 1})
        for (const int sj : {-1, 1})
          if (touching_line(a, b, i, j, si, sj, reach, shaft.planes[shaft.count])) ++shaft.count;
  return shaft;
}

namespace {

constexpr double most = std::numeric_limits<float>::max();

float rounded_up(double x) {
  const float f = static_cast<float>(std::clamp(x, -most, most));
  return double{f} < std::min(x, most) ? std::nextafter(f, INFINITY) : f;
}

}  // namespace

// |m| + |n| is 1 but for rounding: the value of a plane rounds by less than 2^-21 of the reach.
FloatShaft::FloatShaft(const BoxShaft& shaft, double reach) : count(shaft.count) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = -rounded_up(-shaft.box.low[axis]);
    high[axis] = rounded_up(shaft.box.high[axis]);
  }
  for (int p = 0; p < count; ++p) {
    const BoxShaft::Plane& plane = shaft.planes[p];
    planes[p] = {plane.m > 0 ? plane.i : 3 + plane.i, plane.n > 0 ? plane.j : 3 + plane.j,
                 static_cast<float>(plane.m), static_cast<float>(plane.n),
                 rounded_up(plane.limit + 0x1p-20 * reach + 0x1p-120)};
  }
}

}  // namespace tenebra::trees
