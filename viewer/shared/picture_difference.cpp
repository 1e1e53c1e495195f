#include "shared/picture_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "math/srgb.h"

namespace tenebra::viewer {
namespace {

constexpr int largest_value = 255;

using Pixel = std::array<int, 4>;

/// Pixel `index` as red, green, blue, alpha.
Pixel pixel_of(const io::Image8& image, std::size_t index) {
  const std::uint8_t* values = image.pixels.data() + index * static_cast<std::size_t>(image.channels);
  switch (image.channels) {
    case 1:
      return {values[0], values[0], values[0], largest_value};
    case 2:
      return {values[0], values[0], values[0], values[1]};
    case 3:
      return {values[0], values[1], values[2], largest_value};
    default:
      return {values[0], values[1], values[2], values[3]};
  }
}

int largest_difference(const Pixel& a, const Pixel& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// 0 for what is the same, infinite values and NaN included; infinite where one of two that differ is not
/// finite.
double distance(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double difference = double{a} - double{b};
  return std::isfinite(difference) ? difference : std::numeric_limits<double>::infinity();
}

}  // namespace

PictureDifference compare_pictures(const io::Image8& a, const io::Image8& b, int threshold,
                                   io::Image8* marked) {
  PictureDifference result;
  result.pixels = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
  if (marked) *marked = {a.width, a.height, 3, std::vector<std::uint8_t>(result.pixels * 3)};
  for (std::size_t i = 0; i < result.pixels; ++i) {
    const Pixel in_a = pixel_of(a, i);
    const int difference = largest_difference(in_a, pixel_of(b, i));
    result.largest = std::max(result.largest, difference);
    const bool differs = difference > threshold;
    result.differing += differs ? 1 : 0;
    if (!marked) continue;
    const auto grey = static_cast<std::uint8_t>((in_a[0] + in_a[1] + in_a[2]) / 12);
    std::uint8_t* out = marked->pixels.data() + i * 3;
    out[0] = differs ? largest_value : grey;
    out[1] = out[2] = differs ? 0 : grey;
  }
  return result;
}

ValueDifference compare_values(const io::ImageF& a, const io::ImageF& b, double threshold,
                               io::Image8* marked) {
  ValueDifference result;
  result.pixels = a.pixels.size() / 3;
  if (marked) *marked = {a.width, a.height, 3, std::vector<std::uint8_t>(a.pixels.size())};
  for (std::size_t i = 0; i < result.pixels; ++i) {
    double difference = 0, shown = 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      difference = std::max(difference, std::abs(distance(a.pixels[c], b.pixels[c])));
      shown += math::srgb_of_linear(a.pixels[c] > 0 ? std::min(double{a.pixels[c]}, 1.0) : 0.0);
    }
    result.largest = std::max(result.largest, difference);
    const bool differs = difference > threshold;
    result.differing += differs ? 1 : 0;
    if (!marked) continue;
    std::uint8_t* const out = marked->pixels.data() + 3 * i;
    out[0] = differs ? largest_value : static_cast<std::uint8_t>(largest_value * shown / 12);
    out[1] = out[2] = differs ? 0 : out[0];
  }
  return result;
}

double rms_difference(const io::Image8& a, const io::Image8& b) {
  const std::size_t count = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Pixel in_a = pixel_of(a, i), in_b = pixel_of(b, i);
    for (std::size_t c = 0; c < 3; ++c) sum += (in_a[c] - in_b[c]) * (in_a[c] - in_b[c]);
  }
  return std::sqrt(sum / (3 * static_cast<double>(count)));
}

double rms_difference(const io::ImageF& a, const io::ImageF& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = distance(a.pixels[i], b.pixels[i]);
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

io::Image8 absolute_difference(const io::Image8& a, const io::Image8& b, int gain) {
  io::Image8 out{a.width, a.height, a.channels, std::vector<std::uint8_t>(a.pixels.size())};
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    const int difference = std::abs(a.pixels[i] - b.pixels[i]) * gain;
    out.pixels[i] = static_cast<std::uint8_t>(std::min(difference, largest_value));
  }
  return out;
}

}  // namespace tenebra::viewer
