#include "math/predicates.h"

#include <cmath>

#include "math/expansion.h"

namespace tenebra::math {

namespace {

using glm::dvec3;
using glm::vec3;

ExactVector exact_normal(const vec3& a, const vec3& b, const vec3& c) {
  return cross(exact_difference(b, a), exact_difference(c, a));
}

// n.v of float differences in double: each of the 3 products of 3 differences carries at most 9 roundings and
// the sum 2 more, so |error| < 2^-46 |e1||e2||v| with room to spare (numerics: record of a triangle).
int filtered_sign(const dvec3& e1, const dvec3& e2, const dvec3& v) {
  const double value = glm::dot(glm::cross(e1, e2), v);
  const double bound = 0x1p-46 * std::sqrt(glm::dot(e1, e1) * glm::dot(e2, e2) * glm::dot(v, v));
  if (value > bound) return 1;
  if (value < -bound) return -1;
  return 0;
}

}  // namespace

int edge_side(const vec3& l, const vec3& a, const vec3& b, const dvec3& p) {
  return dot(cross(exact_difference(a, l), exact_difference(b, l)), exact_difference(p, l)).sign();
}

int edge_side_infinite(const vec3& direction, const vec3& a, const vec3& b, const dvec3& p) {
  return dot(cross(exact_difference(b, a), exact_vector(direction)), exact_difference(p, a)).sign();
}

int plane_excess(const vec3& a, const vec3& b, const vec3& c, const dvec3& p, int s, double threshold) {
  const Expansion height = dot(exact_normal(a, b, c), exact_difference(p, a));
  return ((s > 0 ? height : -height) - Expansion(threshold)).sign();
}

int point_side(const vec3& a, const vec3& b, const vec3& c, const vec3& p) {
  const int sign = filtered_sign(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a), dvec3(p) - dvec3(a));
  return sign != 0 ? sign : dot(exact_normal(a, b, c), exact_difference(p, a)).sign();
}

int direction_side(const vec3& a, const vec3& b, const vec3& c, const vec3& direction) {
  const int sign = filtered_sign(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a), dvec3(direction));
  return sign != 0 ? sign : dot(exact_normal(a, b, c), exact_vector(direction)).sign();
}

}  // namespace tenebra::math
