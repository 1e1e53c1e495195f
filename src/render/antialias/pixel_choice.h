// Which pixels need more than the sample at their centre.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "io/image.h"
#include "render/antialias/surface_match.h"
#include "shade/light_terms.h"
#include "visibility/place_ids.h"

namespace tenebra::render {

/// A frame whose pixels have one sample each.
struct CentrePicture {
  int width = 0;
  int height = 0;
  std::span<const std::uint32_t> ids;    ///< opaque triangles, or no_triangle
  std::span<const std::uint32_t> layer;  ///< see-through ones before them; empty: the frame has none
  const io::Image8& picture;
  std::vector<std::span<const std::uint8_t>> masks;  ///< of each light
  std::vector<shade::TintFactors> tints;             ///< of each light, where something lets light through
};

/// Pixels that need more samples, sixteen by sixteen and four by four, so that neighbours are near each other
/// in the lists.
struct ChosenPixels {
  /// By geometry, without a miss: pixels whose samples do not all see one surface (SurfaceMatch). By shadow:
  /// pixels whose mask of some light differs from that of the next pixel to the right, to the left, above or
  /// below (in soft masks: one is below half, the other is not), where both see one surface, or whose tint
  /// differs by more than an eighth. The edge of a half plane that reaches into a pixel comes between its
  /// centre and one of those four, so only shapes thinner or rounder than a pixel are missed.
  std::vector<std::uint32_t> edges;
  /// By contrast: other pixels whose drawn colour differs by more than least_contrast(samples) from one of
  /// those four on the same surface (textures, penumbrae, highlights), and from the continuation of a
  /// straight ramp there, whose mean is the value of its middle. Their light is that of their centre. Where
  /// something see-through is in front of them, or changes the colour of a light, they are edges.
  std::vector<std::uint32_t> contrasts;

  std::size_t count() const { return edges.size() + contrasts.size(); }
  /// The edges, then the contrasts.
  std::vector<std::uint32_t> all() const {
    std::vector<std::uint32_t> out(edges);
    out.insert(out.end(), contrasts.begin(), contrasts.end());
    return out;
  }
};

/// Levels of 255 by which a channel of two neighbours on one surface may differ. The change that one sample
/// makes falls with their number; up to four samples are off by a quarter of all levels themselves.
constexpr int least_contrast(std::size_t samples) {
  return samples <= 4 ? 64 : 255 / (2 * static_cast<int>(samples));
}

/// `everywhere`: all pixels are edges.
ChosenPixels choose_pixels(const CentrePicture& centre, std::span<const glm::vec2> offsets,
                           const visibility::PlaceIds& seen, const SurfaceMatch& match, bool everywhere);

}  // namespace tenebra::render
