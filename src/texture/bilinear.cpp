#include "texture/bilinear.h"

#include <algorithm>
#include <cmath>

namespace tenebra::texture {
namespace {

glm::vec4 pixel(const TextureImage& image, int x, int y) {
  const std::uint8_t* values =
      image.rgba.data() +
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return glm::vec4(values[0], values[1], values[2], values[3]);
}

}  // namespace

int wrap(std::int64_t i, int size, Wrap mode) {
  const std::int64_t n = size;
  if (mode == Wrap::clamp_to_edge) return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t period = mode == Wrap::repeat ? n : 2 * n;
  const std::int64_t at = ((i % period) + period) % period;
  return static_cast<int>(at < n ? at : period - 1 - at);
}

glm::vec4 sample_bilinear(const TextureImage& image, const TextureMap& map, glm::vec2 uv) {
  // In double: a repeated texture far from 0 keeps its fractions.
  const glm::dvec2 place = glm::dmat3x2(map.transform) * glm::dvec3(uv, 1.0);
  const double x = place.x * image.width - 0.5, y = place.y * image.height - 0.5;
  constexpr double largest = 2147483648.0;
  if (!(std::abs(x) < largest && std::abs(y) < largest)) return pixel(image, 0, 0) * (1.0f / 255.0f);
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto column = static_cast<std::int64_t>(x0), row = static_cast<std::int64_t>(y0);
  const int left = wrap(column, image.width, map.wrap_u), right = wrap(column + 1, image.width, map.wrap_u);
  const int top = wrap(row, image.height, map.wrap_v), bottom = wrap(row + 1, image.height, map.wrap_v);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const glm::vec4 upper = glm::mix(pixel(image, left, top), pixel(image, right, top), fx);
  const glm::vec4 lower = glm::mix(pixel(image, left, bottom), pixel(image, right, bottom), fx);
  return glm::mix(upper, lower, fy) * (1.0f / 255.0f);
}

}  // namespace tenebra::texture
