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

/// (u x v).w in double, and the sum of what its six products are at most.
struct Product {
  double value, size;
};
Product triple_product(const dvec3& u, const dvec3& v, const dvec3& w) {
  const auto row = [](double a, double b, double c, double d, double by) {
    const double ab = a * b, cd = c * d;
    return Product{(ab - cd) * by, (std::abs(ab) + std::abs(cd)) * std::abs(by)};
  };
  const Product x = row(u.y, v.z, u.z, v.y, w.x), y = row(u.z, v.x, u.x, v.z, w.y),
                z = row(u.x, v.y, u.y, v.x, w.z);
  return {x.value + y.value + z.value, x.size + y.size + z.size};
}

// Where the coordinates of u, v and w are off by v = 2^-53 of themselves a product of three carries five
// roundings, the difference one and the sum two: 8v of its size, and what `value` is off besides. Product by
// product, not length by length: of a light very far away along an axis the largest products are often 0.
int certain_sign(const Product& p, double off) {
  const double bound = 0x1p-49 * (p.size + off) + 0x1p-1000;
  return p.value > bound ? 1 : p.value < -bound ? -1 : 0;
}

}  // namespace

int edge_side(const vec3& l, const vec3& a, const vec3& b, const dvec3& p) {
  const int sign = certain_sign(triple_product(dvec3(a) - dvec3(l), dvec3(b) - dvec3(a), p - dvec3(a)), 0);
  if (sign != 0) return sign;
  return dot(cross(exact_difference(a, l), exact_difference(b, l)), exact_difference(p, l)).sign();
}

int edge_side_infinite(const vec3& direction, const vec3& a, const vec3& b, const dvec3& p) {
  const int sign = certain_sign(triple_product(dvec3(b) - dvec3(a), dvec3(direction), p - dvec3(a)), 0);
  if (sign != 0) return sign;
  return dot(cross(exact_difference(b, a), exact_vector(direction)), exact_difference(p, a)).sign();
}

int plane_excess(const vec3& a, const vec3& b, const vec3& c, const dvec3& p, int s, double threshold) {
  Product rough = triple_product(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a), p - dvec3(a));
  rough.value = (s > 0 ? rough.value : -rough.value) - threshold;
  if (const int sign = certain_sign(rough, std::abs(threshold)); sign != 0) return sign;
  const Expansion height = dot(exact_normal(a, b, c), exact_difference(p, a));
  return ((s > 0 ? height : -height) - Expansion(threshold)).sign();
}

int point_side(const vec3& a, const vec3& b, const vec3& c, const vec3& p) {
  const int sign =
      certain_sign(triple_product(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a), dvec3(p) - dvec3(a)), 0);
  return sign != 0 ? sign : dot(exact_normal(a, b, c), exact_difference(p, a)).sign();
}

int direction_side(const vec3& a, const vec3& b, const vec3& c, const vec3& direction) {
  const int sign =
      certain_sign(triple_product(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a), dvec3(direction)), 0);
  return sign != 0 ? sign : dot(exact_normal(a, b, c), exact_vector(direction)).sign();
}

}  // namespace tenebra::math
