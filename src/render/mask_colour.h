// A light's mask as values: fractions, levels, and levels times the tint of see-through surfaces.
#pragma once

#include <cstddef>
#include <cstdint>

#include "io/image.h"
#include "render/renderer.h"

namespace tenebra::render {

/// 0 to 1: how much of the light is visible from a pixel; of a light without an area 0 or 1.
float visible_fraction(const LightMask& mask, std::size_t pixel);

/// Fractions times 255, rounded.
std::uint8_t in_levels(float fraction);
io::Image8 in_levels(const io::ImageF& fractions);

/// Three channels, 0 to 1: what is lit (soft: the visible fraction) times LightMask::tint.
io::ImageF mask_colour(const LightMask& mask);
/// Those channels times 255, rounded; without a tint each is the mask.
io::Image8 mask_colour8(const LightMask& mask);

}  // namespace tenebra::render
