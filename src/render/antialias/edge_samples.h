// The samples of pixels with an edge, and which of them need hard shadows of their own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/antialias/centre_shadows.h"
#include "render/antialias/shading_list.h"
#include "render/antialias/surface_match.h"
#include "visibility/place_ids.h"

namespace tenebra::render {

/// Pixels, their samples and what the centres say: what the functions below read.
struct EdgeTask {
  std::span<const std::uint32_t> pixels;  ///< of the frame; no glass is near (part_by_glass)
  const CentreShadows& centres;
  std::span<const glm::vec2> offsets;
  const visibility::PlaceIds& seen;  ///< at the offsets
  const SurfaceMatch& match;
};

/// Which samples have which shadow. Where no edge of a shadow is near, samples have that of pixels' centres:
///
/// - The samples of a surface that two or more of the centres of a pixel and the eight around it see, all in
///   the same light, are taken to be in that light.
/// - Elsewhere the same goes for a sample that lies between three such centres, one of them its pixel's, that
///   see its surface in the same light.
///
/// All others have shadows of their own.
struct EdgeSamples {
  std::size_t per_pixel = 0;
  std::vector<std::uint8_t> surfaces;  ///< of sample k of pixel i: [i * per_pixel + k]; 0: the centre's
  std::vector<LitBits> lit;            ///< likewise
  /// Samples to be traced; those that are alike follow each other.
  struct Own {
    std::uint32_t number;  ///< i * per_pixel + k
    std::uint32_t id;      ///< of the triangle that it sees
    glm::vec2 place;       ///< in the window, pixels
  };
  std::vector<Own> own;
};

/// Sorts out which of the samples are to be traced.
void find_edge_samples(const EdgeTask& task, EdgeSamples& out);

/// Where they are and what they see, as compute_sample_points takes them.
void place_own(std::span<const EdgeSamples::Own> own, std::vector<std::uint32_t>& ids,
               std::vector<glm::vec2>& places);

/// What is shaded: one sample for those of a pixel that see one surface in the same light, as list_groups
/// does; `from` are the LitBits.
void list_edges(const EdgeTask& task, const EdgeSamples& samples, ShadingList& out);

/// Puts the pixels that see glass nearby before the others; returns how many they are.
std::size_t part_by_glass(const EdgeTask& task, std::vector<std::uint32_t>& pixels);

}  // namespace tenebra::render
