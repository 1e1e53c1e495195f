#include "formats/images/derived.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace tenebra::formats {
namespace {

const std::uint8_t* pixel(const TextureImage& image, int x, int y) {
  return &image.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x))];
}

int brightness(const std::uint8_t* rgba) {
  return (rgba[0] + rgba[1] + rgba[2] + 1) / 3;
}

bool has_alpha(const TextureImage& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    if (image.rgba[i] != 255) return true;
  return false;
}

/// A picture named as `a`, as wide and high as the larger in each direction: `join` makes a pixel of four
/// values from the nearest of both.
template <class Join>
TextureImage joined(const TextureImage& a, const TextureImage& b, Join join) {
  TextureImage both{a.name, std::max(a.width, b.width), std::max(a.height, b.height), {}};
  both.rgba.reserve(4 * static_cast<std::size_t>(both.width) * static_cast<std::size_t>(both.height));
  const auto at = [&](const TextureImage& image, int x, int y) {
    const auto scaled = [](int i, int size, int of) { return static_cast<int>(std::int64_t{i} * size / of); };
    return pixel(image, scaled(x, image.width, both.width), scaled(y, image.height, both.height));
  };
  for (int y = 0; y < both.height; ++y) {
    for (int x = 0; x < both.width; ++x) {
      const std::array<std::uint8_t, 4> values = join(at(a, x, y), at(b, x, y));
      both.rgba.insert(both.rgba.end(), values.begin(), values.end());
    }
  }
  return both;
}

std::uint8_t encoded(double component) {
  return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * component));
}

}  // namespace

bool holds_heights(const TextureImage& bumps) {
  constexpr std::size_t most_apart = 8;  // levels in the mean: what a JPEG makes of greys
  std::size_t apart = 0;
  for (std::size_t i = 0; i < bumps.rgba.size(); i += 4)
    apart += static_cast<std::size_t>(std::abs(bumps.rgba[i] - bumps.rgba[i + 2]));
  return apart <= most_apart * (bumps.rgba.size() / 4);
}

TextureImage normals_of_heights(const TextureImage& heights, double height) {
  TextureImage normals{heights.name, heights.width, heights.height, {}};
  normals.rgba.reserve(heights.rgba.size());
  const int w = heights.width, h = heights.height;
  const auto rise = [&](int x1, int y1, int x2, int y2) {
    return height / 510 *
           (brightness(pixel(heights, x2 % w, y2 % h)) - brightness(pixel(heights, x1 % w, y1 % h)));
  };
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const double right = rise(x + w - 1, y, x + 1, y), up = rise(x, y + 1, x, y + h - 1);
      const double length = std::sqrt(right * right + up * up + 1);
      normals.rgba.insert(normals.rgba.end(),
                          {encoded(-right / length), encoded(-up / length), encoded(1 / length), 255});
    }
  }
  return normals;
}

TextureImage with_alpha(const TextureImage& colors, const TextureImage& shares) {
  const bool by_alpha = has_alpha(shares);
  return joined(colors, shares, [&](const std::uint8_t* color, const std::uint8_t* share) {
    const int alpha = by_alpha ? share[3] : brightness(share);
    return std::array{color[0], color[1], color[2], static_cast<std::uint8_t>(alpha)};
  });
}

TextureImage metallic_roughness(const TextureImage& roughness, const TextureImage& metallic) {
  return joined(roughness, metallic, [](const std::uint8_t* rough, const std::uint8_t* metal) {
    return std::array{std::uint8_t{255}, static_cast<std::uint8_t>(brightness(rough)),
                      static_cast<std::uint8_t>(brightness(metal)), std::uint8_t{255}};
  });
}

bool cuts_out(const TextureImage& image) {
  constexpr int nearly = 16;
  std::size_t between = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    between += image.rgba[i] >= nearly && image.rgba[i] <= 255 - nearly;
  return between <= image.rgba.size() / 4 / 8;
}

}  // namespace tenebra::formats
