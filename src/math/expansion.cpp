#include "math/expansion.h"

#include <cmath>
#include <utility>

namespace tenebra::math {

namespace {

// a + b = sum + error, exactly (Knuth's two-sum).
std::pair<double, double> two_sum(double a, double b) {
  const double sum = a + b;
  const double b_virtual = sum - a;
  const double a_virtual = sum - b_virtual;
  return {sum, (a - a_virtual) + (b - b_virtual)};
}

}  // namespace

Expansion::Expansion(double value) {
  if (value != 0) terms_.push_back(value);
}

int Expansion::sign() const {
  return terms_.empty() ? 0 : (terms_.back() > 0 ? 1 : -1);
}

Expansion Expansion::difference(double a, double b) {
  const auto [sum, error] = two_sum(a, -b);
  Expansion result(error);
  if (sum != 0) result.terms_.push_back(sum);
  return result;
}

Expansion Expansion::product(double a, double b) {
  const double high = a * b;
  Expansion result(std::fma(a, b, -high));
  if (high != 0) result.terms_.push_back(high);
  return result;
}

void Expansion::add(double term) {
  std::size_t kept = 0;
  for (const double existing : terms_) {
    const auto [sum, error] = two_sum(term, existing);
    if (error != 0) terms_[kept++] = error;
    term = sum;
  }
  terms_.resize(kept);
  if (term != 0) terms_.push_back(term);
}

Expansion Expansion::operator-() const {
  Expansion result = *this;
  for (double& term : result.terms_) term = -term;
  return result;
}

Expansion operator+(const Expansion& a, const Expansion& b) {
  Expansion result = a;
  for (const double term : b.terms_) result.add(term);
  return result;
}

Expansion operator-(const Expansion& a, const Expansion& b) {
  return a + -b;
}

Expansion operator*(const Expansion& a, const Expansion& b) {
  Expansion result;
  for (const double x : a.terms_) {
    for (const double y : b.terms_) result = result + Expansion::product(x, y);
  }
  return result;
}

ExactVector exact_difference(const glm::dvec3& a, const glm::dvec3& b) {
  return {Expansion::difference(a.x, b.x), Expansion::difference(a.y, b.y), Expansion::difference(a.z, b.z)};
}

ExactVector exact_vector(const glm::dvec3& a) {
  return {Expansion(a.x), Expansion(a.y), Expansion(a.z)};
}

ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Expansion dot(const ExactVector& a, const ExactVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace tenebra::math
