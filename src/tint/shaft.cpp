#include "tint/shaft.h"

#include <algorithm>
#include <cmath>

namespace tenebra::tint {
namespace {

/// The line that touches two rectangles from the side (`si`, `sj`), if there is one. Its normal is off by at
/// most 2^-52 of the coordinates, and places in the hull are off by at most that times the hull's size: the
/// limit is wider than this and the rounding of its own sums by far.
bool touching_line(const Box& a, const Box& b, int i, int j, int si, int sj, double reach, ShaftPlane& out) {
  const auto corner = [](const Box& box, int axis, int s) { return s > 0 ? box.high[axis] : box.low[axis]; };
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

Shaft shaft_between(const Box& a, const Box& b) {
  Shaft shaft;
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

std::uint32_t boxes_met(const EightBoxes& boxes, const Shaft& shaft) {
  double beyond[box_lanes];  // > 0: apart from the shaft
  for (int k = 0; k < box_lanes; ++k) beyond[k] = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = shaft.box.low[axis], high = shaft.box.high[axis];
    for (int k = 0; k < box_lanes; ++k)
      beyond[k] = std::max({beyond[k], boxes.low[axis][k] - high, low - boxes.high[axis][k]});
  }
  for (int p = 0; p < shaft.count; ++p) {
    const ShaftPlane& plane = shaft.planes[p];
    const float* at_i = plane.m > 0 ? boxes.low[plane.i] : boxes.high[plane.i];
    const float* at_j = plane.n > 0 ? boxes.low[plane.j] : boxes.high[plane.j];
    const double m = plane.m, n = plane.n, limit = plane.limit;
    for (int k = 0; k < box_lanes; ++k) beyond[k] = std::max(beyond[k], m * at_i[k] + n * at_j[k] - limit);
  }
  std::uint32_t met = 0;
  for (int k = 0; k < box_lanes; ++k) met |= static_cast<std::uint32_t>(!(beyond[k] > 0)) << k;
  return met;
}

}  // namespace tenebra::tint
