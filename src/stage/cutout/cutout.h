// Alpha that cuts a surface out (AlphaMode::mask) becomes geometry, once, before anything is drawn: so the
// picture and all three methods see the same triangles.
#pragma once

#include <cstddef>

#include <tenebra/scene.h>

namespace tenebra::stage {

struct CutoutLimits {
  double tolerance_px = 1.0 / 8;       ///< pixels of the texture, 1/64 or more
  std::size_t most_added = 1'000'000;  ///< triangles of the scene, instances counted
};

/// What was cut, instances counted. Zeros: nothing had alpha that cuts.
struct CutoutCounts {
  std::size_t triangles = 0;  ///< of materials that cut out
  std::size_t left = 0;       ///< that stand in their place
};

/// Replaces every triangle whose material cuts out by the part of it where alpha (the texture's between its
/// pixels, times Material::alpha, times the vertices') is at least the cutoff, and makes these materials
/// opaque. What holds, and what does not: docs/cutout.md. Says in scene.warnings where `most_added` made
/// it coarser. The same bits for any number of threads.
CutoutCounts cut_out_masks(Scene& scene, const CutoutLimits& limits = {});

}  // namespace tenebra::stage
