#include "formats/placement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/box.h"

namespace tenebra::formats {
namespace {

using Box = math::Box<double>;

bool is_finite(const glm::dvec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

double side(const Box& box) {
  const int axis = box.longest_side();
  return box.high[axis] - box.low[axis];
}

/// Half a unit in the last place of a float is at most 2^-24 of it: eight times that is 2^-21.
bool floats_are_fine(const Box& box) {
  return box.empty() || box.largest_coordinate() <= 8 * side(box);
}

Box bounds(std::span<const glm::dvec3> points) {
  Box box;
  for (const glm::dvec3& point : points)
    if (is_finite(point)) box.add(point);
  return box;
}

/// Without the 2 % at each end of each axis. Of very many points every n-th is looked at.
Box bounds_of_most(std::span<const glm::dvec3> points) {
  constexpr std::size_t enough = 1 << 16;
  const std::size_t step = points.size() / enough + 1;
  std::vector<double> values;
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t i = 0; i < points.size(); i += step)
      if (is_finite(points[i])) values.push_back(points[i][axis]);
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
bool rounds_visibly(const Box& box, double metres_per_unit) {
  constexpr double rounding = 1.7320508075688772 * 0x1p-24;  // of a vertex, for a largest coordinate of 1
  return rounding * box.largest_coordinate() * metres_per_unit > 0.5e-3;
}

/// The smallest of 1, 2, 5, 10, 20 ... above `size`.
double round_number_above(double size) {
  double power = 1;
  while (10 * power <= size) power *= 10;
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power > size) return digit * power;
  return 10 * power;
}

glm::dvec3 automatic_origin(std::span<const glm::dvec3> points, std::span<const glm::dvec3> carriers,
                            double metres_per_unit) {
  Box box = bounds(points);
  if (floats_are_fine(box)) {
    box = bounds_of_most(points);
    if (floats_are_fine(box) || !rounds_visibly(box, metres_per_unit)) return glm::dvec3(0);
  }
  for (const glm::dvec3& carrier : carriers) {
    const glm::dvec3 origin = glm::round(carrier);
    if (is_finite(origin) && floats_are_fine({box.low - origin, box.high - origin})) return origin;
  }
  const double step = round_number_above(side(box));
  return glm::round(box.centre() / step) * step + 0.0;  // + 0: no minus zeros
}

}  // namespace

FileFrame choose_frame(const Placement& placement, const FormatCoordinates& format,
                       std::span<const glm::dvec3> points, std::span<const glm::dvec3> carriers) {
  FileFrame frame;
  frame.up = placement.up.value_or(format.up);
  frame.metres_per_unit = placement.metres_per_unit.value_or(format.metres_per_unit);
  if (placement.offset == OffsetChoice::given) frame.origin = placement.given_offset;
  if (placement.offset == OffsetChoice::automatic)
    frame.origin = automatic_origin(points, carriers, frame.metres_per_unit);
  return frame;
}

}  // namespace tenebra::formats
