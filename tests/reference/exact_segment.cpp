#include "reference/exact_segment.h"

#include "oracle/dyadic.h"

namespace tenebra::reference {

using oracle::Bounded, oracle::Dyadic, oracle::unknown_sign;

namespace {

template <class N>
struct Vector {
  N x, y, z;
  Vector(const glm::dvec3& to, const glm::dvec3& from)
      : x(N(to.x) - N(from.x)), y(N(to.y) - N(from.y)), z(N(to.z) - N(from.z)) {}
};
/// Determinant of three rows, by the rule of Sarrus.
template <class N>
N determinant(const Vector<N>& a, const Vector<N>& b, const Vector<N>& c) {
  return a.x * b.y * c.z + a.y * b.z * c.x + a.z * b.x * c.y - a.z * b.y * c.x - a.y * b.x * c.z -
         a.x * b.z * c.y;
}

template <class N>
int height_as(const points::Corners& t, const glm::dvec3& x, double offset) {
  const glm::dvec3 a(t.v[0]);
  return (determinant(Vector<N>(t.v[1], a), Vector<N>(t.v[2], a), Vector<N>(x, a)) - N(offset)).sign();
}

template <class N>
int turn_as(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b) {
  return determinant(Vector<N>(q, p), Vector<N>(a, p), Vector<N>(b, p)).sign();
}

/// Which way edge a-b turns around the line from p to q.
int turn(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b) {
  const int sign = turn_as<Bounded>(p, q, a, b);
  return sign != unknown_sign ? sign : turn_as<Dyadic>(p, q, a, b);
}

}  // namespace

int height_sign(const points::Corners& triangle, const glm::dvec3& x, double offset) {
  const int sign = height_as<Bounded>(triangle, x, offset);
  return sign != unknown_sign ? sign : height_as<Dyadic>(triangle, x, offset);
}

bool blocks(const points::Corners& triangle, double theta, const glm::dvec3& p, const glm::dvec3& q) {
  const int side = height_sign(triangle, p);
  if (side == 0 || height_sign(triangle, q) != -side) return false;
  if (side > 0 ? height_sign(triangle, p, theta) <= 0 : height_sign(triangle, p, -theta) >= 0) return false;
  bool left = false, right = false;
  for (int k = 0; k < 3; ++k) {
    const int sign = turn(p, q, glm::dvec3(triangle.v[k]), glm::dvec3(triangle.v[(k + 1) % 3]));
    left |= sign > 0, right |= sign < 0;
  }
  return !(left && right);
}

}  // namespace tenebra::reference
