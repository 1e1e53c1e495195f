// Which pixels need more than the sample at their centre.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/image.h"
#include "render/antialias/sample_picture.h"
#include "render/antialias/surface_match.h"

namespace tenebra::render {

/// What is known of a frame whose pixels have one sample each.
struct CentrePicture {
  int width = 0;
  int height = 0;
  std::span<const std::uint32_t> ids, layer;  ///< as SampleIds
  const base::Image8& picture;
  std::vector<std::span<const std::uint8_t>> masks;  ///< of each light
};

/// Levels of 255 by which two neighbours on one surface may differ in a channel and still be done with one
/// sample each.
constexpr int least_contrast = 8;

/// Pixels that need more samples, sixteen by sixteen and four by four, so that neighbours are near each other
/// in the list:
/// - by geometry, without a miss: those with samples that do not all see one surface (SurfaceMatch);
/// - by shadow: those whose mask of some light is not that of the next pixel to the right, to the left, above
///   or below, where both see one surface. The edge of a half plane that reaches into a pixel comes between
///   its centre and one of those four, so what is missed is what is thinner or rounder than a pixel;
/// - by what is drawn there (textures, penumbrae, highlights): likewise, where the pictures differ by more
/// than
///   least_contrast.
/// `everywhere`: all pixels.
std::vector<std::uint32_t> choose_pixels(const CentrePicture& centre, std::span<const glm::vec2> offsets,
                                         std::span<const SampleIds> seen, const SurfaceMatch& match,
                                         bool everywhere);

}  // namespace tenebra::render
