// Vectors of any kind of number, for formulas that are evaluated with bounds first and exactly then.
#pragma once

#include <utility>

namespace tenebra::oracle {

template <class T>
struct Vector {
  T x, y, z;
  Vector() = default;
  Vector(T x_, T y_, T z_) : x(std::move(x_)), y(std::move(y_)), z(std::move(z_)) {}
  /// The vector of floats or doubles, exactly.
  template <class V>
  explicit Vector(const V& v) : x(double(v.x)), y(double(v.y)), z(double(v.z)) {}
};
template <class T>
Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
T dot(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace tenebra::oracle
