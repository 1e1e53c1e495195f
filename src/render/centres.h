// The samples at the centres of a frame's pixels.
#pragma once

#include <vector>

#include "render/frame.h"
#include "render/lit_samples.h"
#include "shade/shading.h"
#include "visibility/visibility.h"

namespace tenebra::render {

/// What the centres see, and the light there.
struct Centres {
  visibility::VisibleIds seen;
  LitSamples lit;
  std::vector<shade::LightFactors> factors;  ///< views of `lit`, for as long as that stays as it is

  std::size_t size() const { return seen.ids.size(); }
  shade::PixelSamples samples() const { return {seen.width, seen.height, seen.ids, factors, lit.openness}; }
};

/// The points of centres whose ids are known, where shadows and occlusion start from, with normals where
/// something asks for them. Nothing asks for points without shadows or occlusion.
void find_centre_points(const Frame& frame, Centres& centres, FrameTimings& timings);

/// Gives what is known of each light at the centres to the masks of a result, which has one for each.
void hand_over_masks(const Frame& frame, Centres& centres, FrameResult& result);
/// Takes the memory of such masks for the next frame.
void reuse_masks(std::vector<LightMask>& masks, Centres& centres);

}  // namespace tenebra::render
