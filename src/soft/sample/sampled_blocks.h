// Pixels that see an area light through many occluders, in blocks of 8x8. The pixels of a block have four
// phases, one for each place in a square of 2x2: each phase gets places on the light of its own, and a mean
// over 3x3 pixels weighs the four alike (Keller and Heidrich 2001, "Interleaved sampling").
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/visible_points.h>
#include "soft/solve/soft_frame.h"

namespace tenebra::soft {

inline constexpr std::uint32_t phases = 4, phase_slots = 16, block_slots = phases * phase_slots;
inline constexpr std::uint32_t block_side = 8;
inline constexpr std::uint32_t no_slot = 0xffffffffu, no_pixel = 0xffffffffu;

/// What is seen at a slot. Positions are relative to the light's origin, along the world's axes, in units of
/// the light's size; for a sun all are the same.
struct SampledSurface {
  glm::vec3 at{0.0f};
  glm::vec3 normal{0.0f};  ///< shading; unit
  glm::vec3 face{0.0f};    ///< of the triangle, to the seen side; unit
  bool sees_half = false;  ///< a free point to which nothing comes from behind `face`
};

/// A block has a slot for each pixel, those of a phase side by side, each phase row by row.
struct SampledBlocks {
  int width = 0, height = 0;  ///< of the picture
  std::vector<std::uint32_t>
      block_at;  ///< by the place in the picture, row by row: number of a block, or no_slot
  std::vector<std::uint32_t> places;  ///< of each block; along a Z curve
  std::vector<std::uint32_t> pixels;  ///< of each slot; no_pixel
  std::vector<SampledSurface> surfaces;

  std::uint32_t columns() const { return (static_cast<std::uint32_t>(width) + block_side - 1) / block_side; }
  std::size_t count() const { return places.size(); }
  /// The slot of the pixel at (x, y), inside the picture or not; no_slot: it is not sampled.
  std::uint32_t slot(int x, int y) const;
  std::uint32_t slot(std::uint32_t pixel) const {
    const auto columns_of_pixels = static_cast<std::uint32_t>(width);
    return slot(static_cast<int>(pixel % columns_of_pixels), static_cast<int>(pixel / columns_of_pixels));
  }
};

/// The blocks of `pixels`: in any order; what is made does not depend on it.
void find_blocks(const SoftFrame& frame, std::span<const std::uint32_t> pixels, SampledBlocks& out);

/// Points of one phase of some blocks: slot `phase` * 16 + i of the k-th of them is sample 16 k + i of a
/// points::SampleGrid. With tiles.
void take_phase(const SoftFrame& frame, const SampledBlocks& blocks, std::span<const std::uint32_t> chosen,
                std::uint32_t phase, VisiblePoints& out);

}  // namespace tenebra::soft
