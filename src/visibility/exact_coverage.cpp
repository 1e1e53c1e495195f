#include "visibility/exact_coverage.h"

#include <cmath>

#include "math/expansion.h"

namespace tenebra::visibility {
namespace {

using glm::dvec3;
using math::ExactVector;

constexpr double bound_factor = 20.0 * 0x1p-53;  // Window::reach

double l1_norm(const dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

ExactVector operator+(const ExactVector& a, const ExactVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// s v; exact, as s has at most 25 bits and v 24.
ExactVector scaled(double s, const dvec3& v) {
  return math::exact_vector(s * v);
}

}  // namespace

int ExactCoverage::facing(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) const {
  const dvec3 from = view_.orthographic ? dvec3(a) : window_.eye;
  const ExactVector v = math::exact_difference(b, from), w = math::exact_difference(c, from);
  const ExactVector u = view_.orthographic ? math::exact_vector(window_.d0) : math::exact_difference(a, from);
  return math::dot(u, math::cross(v, w)).sign();
}

int ExactCoverage::exact_edge_sign(const glm::vec3& a, const glm::vec3& b, const glm::dvec2& place) const {
  const ExactVector across = scaled(place.x, window_.dx) + scaled(place.y, window_.dy);
  const ExactVector qa = math::exact_difference(a, window_.eye), qb = math::exact_difference(b, window_.eye);
  const ExactVector d0 = math::exact_vector(window_.d0);
  if (!view_.orthographic) return math::dot(d0 + across, math::cross(qa, qb)).sign();
  // det(d0, a - s, b - s) = d0.(a x b) + s.(d0 x (b - a)), s = across
  return (math::dot(d0, math::cross(qa, qb)) +
          math::dot(across, math::cross(d0, math::exact_difference(b, a))))
      .sign();
}

int ExactCoverage::edge_sign(const glm::vec3& a, const glm::vec3& b, const glm::dvec2& place) const {
  const dvec3 qa = dvec3(a) - window_.eye, qb = dvec3(b) - window_.eye;
  const dvec3 across = place.x * window_.dx + place.y * window_.dy;
  const dvec3 normal = glm::cross(qa, qb);
  const double value = window_.orthographic
                           ? glm::dot(window_.d0, normal) + glm::dot(across, glm::cross(window_.d0, qb - qa))
                           : glm::dot(window_.d0 + across, normal);
  const double bound =
      bound_factor * (l1_norm(qa) + window_.shift) * (l1_norm(qb) + window_.shift) * window_.reach;
  if (std::abs(value) > bound) return sign_of(value);
  return exact_edge_sign(a, b, place);
}

bool ExactCoverage::meets(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                          const glm::dvec2& place) const {
  const int side = facing(a, b, c);
  return side != 0 && side * edge_sign(b, c, place) >= 0 && side * edge_sign(c, a, place) >= 0 &&
         side * edge_sign(a, b, place) >= 0;
}

}  // namespace tenebra::visibility
