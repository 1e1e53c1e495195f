// The further samples of pixels that need more than one, side by side in a picture of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/visible_points.h>
#include "points/sample_points.h"
#include "visibility/place_ids.h"

namespace tenebra::render {

/// Samples of chosen pixels, as stages take pixels. Lists are by pixel of `grid`, which a few places without
/// a sample fill up: they see nothing.
struct SamplePicture {
  points::SampleGrid grid{0};
  std::size_t count = 0;
  std::size_t per_pixel = 0;
  std::vector<std::uint32_t> ids, layer;
  std::vector<glm::vec2> places;      ///< in the frame's window, pixels
  std::vector<std::uint32_t> pixels;  ///< of the frame
  std::vector<std::uint32_t> slots;   ///< where sample k of chosen pixel i stands: [i * per_pixel + k]

  /// Whether something see-through is before a sample.
  bool has_layer(std::size_t slot) const { return !layer.empty() && layer[slot] != no_triangle; }
};

/// Samples see `seen`, at offsets[k] from the pixel's centre, which sees centre_ids. Of about 256 samples
/// those that see the same triangle as the centre stand together.
void pack_samples(std::span<const std::uint32_t> chosen, int width, std::span<const glm::vec2> offsets,
                  const visibility::PlaceIds& seen, std::span<const std::uint32_t> centre_ids,
                  SamplePicture& out);

}  // namespace tenebra::render
