// Pixels with an edge whose samples need no shadows of their own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/antialias/mask_sharing.h"
#include "render/antialias/shading_list.h"
#include "visibility/place_ids.h"

namespace tenebra::render {

/// Edges of surfaces whose samples all have the masks of centres nearby (MaskAgreement).
struct SettledEdges {
  std::vector<std::uint32_t> others;  ///< pixels that are none, in their order
  std::vector<std::uint32_t> pixels;  ///< that are, in their order
  ShadingList listed;  ///< of `pixels`, as list_groups makes it; lit as pixels of the frame are
};

/// Of `edges`, whose samples see `seen` at offsets[k] from their centres.
void settle_edges(std::span<const std::uint32_t> edges, const CentreMasks& centres,
                  std::span<const glm::vec2> offsets, const visibility::PlaceIds& seen,
                  const SurfaceMatch& match, SettledEdges& out);

}  // namespace tenebra::render
