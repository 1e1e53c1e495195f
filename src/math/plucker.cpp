#include "math/plucker.h"

#include <cmath>

#include "math/expansion.h"

namespace tenebra::math {

using glm::dvec3;

namespace {

double sum(const dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

}  // namespace

PluckerLine line_through(const dvec3& p, const dvec3& q) {
  return {q - p, glm::cross(p, q)};
}

double side(const PluckerLine& a, const PluckerLine& b) {
  return glm::dot(a.direction, b.moment) + glm::dot(a.moment, b.direction);
}

// Seen from a, the line a-b has no moment: the side is ((p - a) x (q - a)).(b - a). Six products of three
// differences, each with at most 5 roundings, and the sum with 3 more: off by less than 9 u of the sum of
// their sizes.
int side_sign(const dvec3& p, const dvec3& q, const dvec3& a, const dvec3& b) {
  const dvec3 from = p - a, to = q - a, edge = b - a;
  const double value = glm::dot(glm::cross(from, to), edge);
  const double bound = 0x1p-49 * sum(from) * sum(to) * sum(edge);
  if (value > bound) return 1;
  if (value < -bound) return -1;
  return dot(cross(exact_difference(p, a), exact_difference(q, a)), exact_difference(b, a)).sign();
}

Orientation orientation(std::span<const dvec3> from, std::span<const dvec3> to, const dvec3& a,
                        const dvec3& b) {
  int common = 0;
  for (const dvec3& p : from) {
    for (const dvec3& q : to) {
      const int sign = side_sign(p, q, a, b);
      if (sign == 0 || sign == -common) return Orientation::mixed;
      common = sign;
    }
  }
  return common > 0 ? Orientation::positive : common < 0 ? Orientation::negative : Orientation::mixed;
}

}  // namespace tenebra::math
