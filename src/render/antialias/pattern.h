// Where the samples of a pixel lie.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/frame_geometry.h>

namespace tenebra::render {

/// The samples of a pixel besides its centre. A pixel's value is the mean over them and, where it counts, the
/// centre: a box filter one pixel wide, since the places fill the pixel evenly.
struct SamplePattern {
  std::span<const glm::vec2> offsets;  ///< from the centre in pixels, less than 0.5 each way; multiples of
                                       ///< 1/64, or of 1/512 for 256 samples
  bool centre_counts = true;

  std::size_t count() const { return offsets.size() + (centre_counts ? 1 : 0); }
};

/// The numbers of samples that a pixel may have: 1, 2, 4, 8, 16, and 256 for comparison.
bool is_sample_count(int samples);

/// The pattern of this many samples. Those of up to sixteen were found by a search for the least mean square
/// error of the coverage of a pixel by half planes, over all their directions and distances; the centre is
/// fixed, so that what the pixels' centres see serves every count, but for two, of which it is none. 256 are
/// Hammersley's points.
SamplePattern sample_pattern(int samples);

/// How widely textures are smoothed at one of `samples` samples per pixel, in pixels, so that the samples
/// together stand for the whole pixel.
float texture_width_px(int samples);

/// Places of a pixel for what is drawn on one surface: the middles of side x side squares that fill it. What
/// a texture repeats from square to square would look the same at all of them, but is not seen: smoothed over
/// a square, it is read between texels of that size, by a tent whose spectrum is zero there.
std::vector<glm::vec2> square_places(int side);

/// The view whose pixels' centres are places at `offset` from those of `view`. Its rays are rounded to float
/// once more: beside the place by about a ten-thousandth of a pixel of a picture a thousand pixels wide.
ViewRays shifted_view(const ViewRays& view, glm::vec2 offset);

}  // namespace tenebra::render
