#include "reference/exact_sight.h"

#include <array>
#include <cmath>

namespace tenebra::test {
namespace {

using Rational3 = std::array<mpq_class, 3>;

Rational3 rational(const glm::vec3& v) {
  return {mpq_class(v.x), mpq_class(v.y), mpq_class(v.z)};
}
Rational3 minus(const Rational3& a, const Rational3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Rational3 crossed(const Rational3& a, const Rational3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
mpq_class dotted(const Rational3& a, const Rational3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Whether the ray surely misses, found in double: Moeller and Trumbore's weights, far outside.
bool surely_misses(const glm::dvec3& from, const glm::dvec3& along, const glm::vec3 corners[3]) {
  const glm::dvec3 a(corners[0]), e1 = glm::dvec3(corners[1]) - a, e2 = glm::dvec3(corners[2]) - a;
  const glm::dvec3 p = glm::cross(along, e2), s = from - a, q = glm::cross(s, e1);
  const double det = glm::dot(e1, p);
  // Below this the weights of a ray within the coordinates' range may be rounding alone.
  if (std::abs(det) < 1e-9 * glm::length(e1) * glm::length(e2) * glm::length(along)) return false;
  const double u = glm::dot(s, p) / det, v = glm::dot(along, q) / det;
  return u < -1e-3 || v < -1e-3 || u + v > 1 + 1e-3;
}

}  // namespace

std::optional<mpq_class> ExactSight::meeting(const glm::vec3 corners[3], int x, int y) const {
  const glm::dvec3 across_d = (x + 0.5) * glm::dvec3(view_.dx) + (y + 0.5) * glm::dvec3(view_.dy);
  const glm::dvec3 eye(view_.eye), d0(view_.d0);
  if (view_.orthographic ? surely_misses(eye + across_d, d0, corners)
                         : surely_misses(eye, d0 + across_d, corners))
    return std::nullopt;
  Rational3 from = rational(view_.eye), along = rational(view_.d0);
  const Rational3 dx = rational(view_.dx), dy = rational(view_.dy);
  Rational3& moved = view_.orthographic ? from : along;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    moved[i] += (mpq_class(2 * x + 1) * dx[i] + mpq_class(2 * y + 1) * dy[i]) / 2;
  }
  const Rational3 a = rational(corners[0]), e1 = minus(rational(corners[1]), a),
                  e2 = minus(rational(corners[2]), a);
  const Rational3 p = crossed(along, e2), s = minus(from, a);
  const mpq_class det = dotted(e1, p);
  if (det == 0) return std::nullopt;
  const mpq_class u = dotted(s, p) / det;
  if (u < 0 || u > 1) return std::nullopt;
  const Rational3 q = crossed(s, e1);
  const mpq_class v = dotted(along, q) / det;
  if (v < 0 || u + v > 1) return std::nullopt;
  const mpq_class t = dotted(e2, q) / det;
  if (!view_.orthographic && t <= 0) return std::nullopt;
  return t;
}

double ExactSight::near_t() const {
  const glm::dvec3 axis = glm::normalize(glm::cross(glm::dvec3(view_.dx), glm::dvec3(view_.dy)));
  return static_cast<double>(view_.near_m) / std::abs(glm::dot(axis, glm::dvec3(view_.d0)));
}

}  // namespace tenebra::test
