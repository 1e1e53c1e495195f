// How far pictures are from others, in levels of 255.
#pragma once

#include <cstddef>

#include "io/image.h"

namespace tenebra::bench {

inline constexpr int missed_step = 16;  ///< of 255, in a channel: from there on a pixel was missed

struct PictureError {
  double rms = 0;     ///< over all pixels and channels
  double missed = 0;  ///< share of the pixels that are off by more than missed_step in a channel
};
/// Of two pictures of one size and three channels.
PictureError picture_error(const io::Image8& picture, const io::Image8& reference);

/// Of the changes from one frame to the next: sums over frames, pixels and channels.
struct ChangeSums {
  double change = 0;     ///< squares of what changes
  double reference = 0;  ///< squares of what changes in the reference
  double apart = 0;      ///< squares of the difference of the two, value by value
  std::size_t values = 0;

  double rms() const;            ///< of what changes
  double reference_rms() const;  ///< likewise
  double flicker() const;        ///< of what changes less what changes in the reference
};
void add_change(const io::Image8& before, const io::Image8& after, const io::Image8& reference_before,
                const io::Image8& reference_after, ChangeSums& sums);

}  // namespace tenebra::bench
