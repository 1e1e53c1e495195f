#include "math/whole_origin.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/box.h"
#include "math/vertex_rounding.h"

namespace tenebra::math {
namespace {

using Extent = Box<double>;

/// Not NaN, and within what a frame may hold (src/scene/frame_geometry.cpp).
bool counts(const glm::dvec3& p) {
  constexpr double largest = 1.8e18;
  return std::abs(p.x) <= largest && std::abs(p.y) <= largest && std::abs(p.z) <= largest;
}

double side(const Extent& box) {
  const int axis = box.longest_side();
  return box.high[axis] - box.low[axis];
}

/// Half a unit in the last place of a float is at most 2^-24 of it: eight times that is 2^-21.
bool floats_are_fine(const Extent& box) {
  return box.empty() || box.largest_coordinate() <= 8 * side(box);
}

Extent bounds(std::span<const glm::dvec3> points) {
  Extent box;
  for (const glm::dvec3& point : points)
    if (counts(point)) box.add(point);
  return box;
}

/// Without the 2 % at each end of each axis. Of very many points every n-th is looked at.
Extent bounds_of_most(std::span<const glm::dvec3> points) {
  constexpr std::size_t enough = 1 << 16;
  const std::size_t step = points.size() / enough + 1;
  std::vector<double> values;
  Extent box;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t i = 0; i < points.size(); i += step)
      if (counts(points[i])) values.push_back(points[i][axis]);
    if (values.empty()) return {};
    const auto cut = static_cast<std::ptrdiff_t>(values.size() / 50);
    std::nth_element(values.begin(), values.begin() + cut, values.end());
    box.low[axis] = values[static_cast<std::size_t>(cut)];
    std::nth_element(values.begin(), values.end() - 1 - cut, values.end());
    box.high[axis] = *(values.end() - 1 - cut);
  }
  return box;
}

/// Whether rounding to float moves a corner of `box` by more than half a millimetre.
bool rounds_visibly(const Extent& box, double metres_per_unit) {
  return vertex_rounding * box.largest_coordinate() * metres_per_unit > 0.5e-3;
}

/// The smallest of 1, 2, 5, 10, 20 ... above `size`.
double round_number_above(double size) {
  double power = 1;
  while (10 * power <= size) power *= 10;
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power > size) return digit * power;
  return 10 * power;
}

}  // namespace

glm::dvec3 whole_origin(std::span<const glm::dvec3> points, std::span<const glm::dvec3> carriers,
                        double metres_per_unit) {
  Extent box = bounds(points);
  if (floats_are_fine(box)) {
    box = bounds_of_most(points);
    if (floats_are_fine(box) || !rounds_visibly(box, metres_per_unit)) return glm::dvec3(0);
  }
  for (const glm::dvec3& carrier : carriers) {
    const glm::dvec3 origin = glm::round(carrier);
    if (counts(origin) && floats_are_fine({box.low - origin, box.high - origin})) return origin;
  }
  const double step = round_number_above(side(box));
  return glm::round(box.centre() / step) * step + 0.0;  // + 0: no minus zeros
}

}  // namespace tenebra::math
