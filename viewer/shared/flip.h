// How different two pictures look to a person: FLIP of Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström
// and Fairchild, "FLIP: A Difference Evaluator for Alternating Images" (2020), for pictures of low dynamic
// range.
#pragma once

#include "io/image.h"

namespace tenebra::viewer {

/// What a monitor 0.7 m wide with 3840 pixels across has, seen from 0.7 m, as the paper assumes.
inline constexpr double pixels_per_degree = 67.0206432765823;

/// The mean over the pixels, 0 (equal) to 1. Both have one size and three channels: linear, of the primaries
/// of sRGB; what is beyond 0 to 1 counts as 0 or 1. The order of the two does not matter. The bits do not
/// depend on the number of threads.
double mean_flip(const io::ImageF& a, const io::ImageF& b);

}  // namespace tenebra::viewer
