// Two kinds of numbers for the oracles: Dyadic, exact, and Bounded, a double that carries a bound of its
// error. A formula written once as a template gives the filter and the exact answer behind it.
#pragma once

#include <gmpxx.h>

#include <cmath>

namespace tenebra::oracle {

/// mantissa * 2^exponent with an unbounded integer: every float and double, and all their sums and products.
class Dyadic {
public:
  Dyadic() = default;
  Dyadic(double value) {  // NOLINT: numbers convert
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    mantissa_ = mpz_class(std::ldexp(fraction, 53));  // an integer below 2^53: conversion is exact
    exponent_ = exponent - 53L;
  }
  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.exponent_ < b.exponent_) return b + a;
    return Dyadic((a.mantissa_ << static_cast<mp_bitcnt_t>(a.exponent_ - b.exponent_)) + b.mantissa_,
                  b.exponent_);
  }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + Dyadic(-b.mantissa_, b.exponent_); }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    return Dyadic(a.mantissa_ * b.mantissa_, a.exponent_ + b.exponent_);
  }
  int sign() const { return sgn(mantissa_); }
  mpq_class rational() const {
    mpq_class q(mantissa_);
    if (exponent_ < 0) return q >> static_cast<mp_bitcnt_t>(-exponent_);
    return q << static_cast<mp_bitcnt_t>(exponent_);
  }
  /// Towards zero: within 2^-63 of the value, relatively.
  long double rounded() const {
    const long drop = static_cast<long>(mpz_sizeinbase(mantissa_.get_mpz_t(), 2)) - 64;
    const mpz_class top =
        drop > 0 ? mpz_class(abs(mantissa_) >> static_cast<mp_bitcnt_t>(drop)) : mpz_class(abs(mantissa_));
    const long double size = std::ldexp(static_cast<long double>(top.get_ui()),
                                        static_cast<int>(exponent_ + (drop > 0 ? drop : 0)));
    return sgn(mantissa_) < 0 ? -size : size;
  }

private:
  Dyadic(mpz_class mantissa, long exponent) : mantissa_(std::move(mantissa)), exponent_(exponent) {}
  mpz_class mantissa_ = 0;
  long exponent_ = 0;
};

/// A sign that a bounded number cannot tell.
inline constexpr int unknown_sign = 2;

/// value +- error. Each operation adds its own rounding, half an ulp <= 2^-53 |result|, to the errors that
/// the operands bring, and 2^-1074 where a product may underflow. The bound's own roundings (fewer than eight
/// of 2^-53 each, all terms positive) are covered by the factor `inflate`. NaN or infinity compares as
/// unknown.
class Bounded {
public:
  Bounded() = default;
  Bounded(double value) : value_(value) {}  // NOLINT: numbers convert
  friend Bounded operator+(Bounded a, Bounded b) {
    const double value = a.value_ + b.value_;
    return {value, (a.error_ + b.error_ + half_ulp * std::abs(value)) * inflate};
  }
  friend Bounded operator-(Bounded a, Bounded b) { return a + Bounded(-b.value_, b.error_); }
  friend Bounded operator*(Bounded a, Bounded b) {
    if ((a.value_ == 0 && a.error_ == 0) || (b.value_ == 0 && b.error_ == 0)) return 0.0;
    const double value = a.value_ * b.value_;
    const double carried = std::abs(a.value_) * b.error_ + a.error_ * (std::abs(b.value_) + b.error_);
    return {value, (carried + half_ulp * std::abs(value)) * inflate + 1e-320};
  }
  int sign() const {
    if (value_ > error_) return 1;
    if (value_ < -error_) return -1;
    return value_ == 0 && error_ == 0 ? 0 : unknown_sign;
  }

private:
  Bounded(double value, double error) : value_(value), error_(error) {}
  static constexpr double half_ulp = 0x1p-53;
  static constexpr double inflate = 1 + 0x1p-49;
  double value_ = 0;
  double error_ = 0;
};

}  // namespace tenebra::oracle
