// How two pictures of one size differ, pixel by pixel.
#pragma once

#include <cstddef>

#include "io/image.h"

namespace tenebra::viewer {

/// Grey counts as equal red, green and blue, and a picture without alpha as opaque.
struct PictureDifference {
  std::size_t pixels = 0;
  std::size_t differing = 0;  ///< by more than the threshold in some channel
  int largest = 0;            ///< of any channel, 0..255
};

/// Sizes must be equal. `marked`, if given: `a` dark and grey, differing pixels red.
PictureDifference compare_pictures(const io::Image8& a, const io::Image8& b, int threshold,
                                   io::Image8* marked = nullptr);

/// How pictures of linear values with three channels differ.
struct ValueDifference {
  std::size_t pixels = 0;
  std::size_t differing = 0;  ///< by more than the threshold in some channel; NaN differs from all but NaN
  double largest = 0;         ///< of any channel; infinite: a value that is not finite differs
};

/// Sizes must be equal. `marked` as above, of what a picture would show of `a`.
ValueDifference compare_values(const io::ImageF& a, const io::ImageF& b, double threshold,
                               io::Image8* marked = nullptr);

/// Root of the mean square of the differences of red, green and blue, in levels of 255 or in values; infinite
/// where a value that is not finite differs.
double rms_difference(const io::Image8& a, const io::Image8& b);
double rms_difference(const io::ImageF& a, const io::ImageF& b);

/// |a - b| of each channel times `gain`, clamped to 255. Sizes and channels must be equal.
io::Image8 absolute_difference(const io::Image8& a, const io::Image8& b, int gain);

}  // namespace tenebra::viewer
