// Means over neighbours that show the same surface.
#pragma once

#include <span>

#include "ao/adaptive/pixel_surfaces.h"

namespace tenebra::ao {

/// One of each for each pixel.
struct PixelValues {
  std::vector<float> open;
  std::vector<float> weight;  ///< its rays, over those of a pixel that looked once
};

/// What the neighbours on a lattice tell about a pixel.
struct Said {
  float value = 1;  ///< their mean, weighted by their distance in the picture and how alike they are
  float share = 0;  ///< 0..1: the weight of those that are alike, of all that there could be
  float least = 1, most = 0;  ///< of the nearest four that are alike
  float farthest = 0;         ///< of the four, to the pixel, in units of the reach
  float nearness = 1;         ///< the least of the four
};

/// By the 4 x 4 of a lattice of `step` pixels around a pixel off it.
Said ask_lattice(const PixelSurfaces& surfaces, std::span<const float> values,
                 std::span<const float> nearness, int x, int y, int step);

/// A pixel's value as the mean over itself and neighbours.
struct Smoothed {
  float value = 1;
  float weight = 1;  ///< of all that went into it, as in PixelValues
};

/// The mean over 5 x 5 pixels of a lattice around one of its pixels: over those that are alike and whose
/// values differ by no more than noise of this standard deviation explains.
Smoothed smoothed(const PixelSurfaces& surfaces, const PixelValues& pixels, int x, int y, int step,
                  float noise);

}  // namespace tenebra::ao
