// Small pictures for tests of textures, made as they are needed.
#pragma once

#include <stb/stb_image_write.h>

#include <string>
#include <vector>

#include "io/image.h"

namespace tenebra::testing {

/// A picture of width * height pixels with four channels whose values follow from their places.
inline io::Image8 small_picture(int width, int height, int seed = 0) {
  io::Image8 image{width, height, 4, {}};
  for (int i = 0; i < 4 * width * height; ++i)
    image.pixels.push_back(static_cast<std::uint8_t>((i * 37 + seed * 11) % 256));
  return image;
}

inline std::string png_of(const io::Image8& image) {
  return io::encode_png(image).value();
}

inline std::string jpeg_of(const io::Image8& image) {
  std::string bytes;
  const auto append = [](void* text, void* data, int size) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  stbi_write_jpg_to_func(append, &bytes, image.width, image.height, image.channels, image.pixels.data(), 95);
  return bytes;
}

/// P6 of one colour.
inline std::string ppm_of(int width, int height, int r, int g, int b) {
  std::string bytes = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  for (int i = 0; i < width * height; ++i)
    for (const int value : {r, g, b}) bytes += static_cast<char>(value);
  return bytes;
}

}  // namespace tenebra::testing
