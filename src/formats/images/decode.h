// The pictures of scenes, whatever their format: PNG, JPEG, PPM; WebP and KTX2 where their
// libraries were found.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <tenebra/material.h>

namespace tenebra::formats {

/// Limits on what a header may claim, so that no small file fills the memory: pixels of one picture and of
/// all pictures of a scene together. A pixel takes four bytes, and up to twelve more while it is decoded.
inline constexpr std::uint64_t most_image_pixels = std::uint64_t{1} << 26;
inline constexpr std::uint64_t most_scene_pixels = std::uint64_t{1} << 27;

/// Decodes a picture and takes its pixels from `pixels_left`. Throws ImportFailure with a phrase ("found ...,
/// expected ...") for what is no picture, is broken, or states a size beyond the limits.
TextureImage decode_image(std::string_view bytes, std::string name, std::uint64_t& pixels_left);

/// Whether this build reads WebP, and KTX2 with Basis Universal.
bool reads_webp();
bool reads_ktx2();

// The formats, each in a file of its own; for decode_image alone.

/// Takes width * height pixels from `pixels_left`; throws ImportFailure where a limit is passed.
void charge_pixels(std::uint64_t width, std::uint64_t height, std::uint64_t& pixels_left);
/// P6 and P3, 8 or 16 bits per value, comments in the header.
TextureImage decode_ppm(std::string_view bytes, std::uint64_t& pixels_left);
TextureImage decode_webp(std::string_view bytes, std::uint64_t& pixels_left);
TextureImage decode_ktx2(std::string_view bytes, std::uint64_t& pixels_left);

}  // namespace tenebra::formats
