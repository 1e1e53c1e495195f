// Exact arithmetic on sums of doubles: a value is the unevaluated sum of the terms of an expansion.
// Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
// section 2. Needs round to nearest, no contraction, no overflow, and products above 2^-1022.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace tenebra::math {

/// Non-overlapping terms of ascending magnitude without zeros; no terms: zero.
class Expansion {
public:
  Expansion() = default;
  explicit Expansion(double value);

  /// -1, 0 or 1: the exact sign (that of the largest term).
  int sign() const;

  /// a - b and a * b of two doubles, exactly.
  static Expansion difference(double a, double b);
  static Expansion product(double a, double b);

  Expansion operator-() const;
  friend Expansion operator+(const Expansion& a, const Expansion& b);
  friend Expansion operator-(const Expansion& a, const Expansion& b);
  friend Expansion operator*(const Expansion& a, const Expansion& b);

private:
  void add(double term);  // Shewchuk's grow-expansion, zeros dropped
  std::vector<double> terms_;
};

/// A vector with exact components.
struct ExactVector {
  Expansion x, y, z;
};

ExactVector exact_difference(const glm::dvec3& a, const glm::dvec3& b);
ExactVector exact_vector(const glm::dvec3& a);
ExactVector cross(const ExactVector& a, const ExactVector& b);
Expansion dot(const ExactVector& a, const ExactVector& b);

}  // namespace tenebra::math
