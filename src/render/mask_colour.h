// A light's mask times what see-through surfaces leave of its colours.
#pragma once

#include "base/image.h"
#include "render/renderer.h"

namespace tenebra::render {

/// Three channels, 0 to 1: what is lit (soft: the visible fraction) times LightMask::tint.
base::ImageF mask_colour(const LightMask& mask);
/// The same times 255, rounded; without a tint each channel is the mask.
base::Image8 mask_colour8(const LightMask& mask);

}  // namespace tenebra::render
