// The curve of sRGB: IEC 61966-2-1, with that standard's constants.
#pragma once

#include <cmath>

namespace tenebra::math {

/// Linear light of an encoded value, both 0 to 1.
template <class T>
T linear_of_srgb(T encoded) {
  return encoded <= T(0.04045) ? encoded / T(12.92) : std::pow((encoded + T(0.055)) / T(1.055), T(2.4));
}
/// The encoded value of linear light, both 0 to 1.
template <class T>
T srgb_of_linear(T linear) {
  return linear <= T(0.0031308) ? T(12.92) * linear : T(1.055) * std::pow(linear, T(1 / 2.4)) - T(0.055);
}

}  // namespace tenebra::math
