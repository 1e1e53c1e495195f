#include "bench/ao/scenes/ao_scene_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tenebra::bench {
namespace {

using Colour = std::array<std::uint8_t, 3>;

std::uint8_t level(double share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

io::Image8 blank(int width, int height, std::uint8_t grey) {
  io::Image8 image{width, height, 3, {}};
  image.pixels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3, grey);
  return image;
}

/// The square of the lattice around a pixel.
void fill(io::Image8& image, std::size_t pixel, int step, const Colour& colour) {
  const int x0 = static_cast<int>(pixel % static_cast<std::size_t>(image.width)) - step / 2;
  const int y0 = static_cast<int>(pixel / static_cast<std::size_t>(image.width)) - step / 2;
  for (int y = std::max(0, y0); y < std::min(image.height, y0 + step); ++y) {
    for (int x = std::max(0, x0); x < std::min(image.width, x0 + step); ++x)
      std::copy(colour.begin(), colour.end(),
                image.pixels.begin() + 3 * (std::ptrdiff_t{y} * image.width + x));
  }
}

}  // namespace

io::Image8 openness_picture(std::span<const float> values, int width, int height) {
  io::Image8 image = blank(width, height, 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint8_t grey = std::isfinite(values[i]) ? level(double{values[i]}) : std::uint8_t{0};
    fill(image, i, 1, {grey, grey, grey});
  }
  return image;
}

io::Image8 truth_picture(const AoSceneTruth& truth, int width, int height) {
  io::Image8 image = blank(width, height, 0);
  for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
    const std::uint8_t grey = level(double{truth.open[k]});
    fill(image, truth.pixels[k], truth.step, {grey, grey, grey});
  }
  return image;
}

io::Image8 error_picture(std::span<const float> values, const AoSceneTruth& truth, int width, int height) {
  constexpr double full = 32.0 / 255;
  io::Image8 image = blank(width, height, 128);
  for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
    const double error = double{values[truth.pixels[k]]} - double{truth.open[k]};
    const std::uint8_t rest = level(1 - std::abs(error) / full);
    fill(image, truth.pixels[k], truth.step, error < 0 ? Colour{255, rest, rest} : Colour{rest, rest, 255});
  }
  return image;
}

Expected<void> write_ao_pictures(const std::filesystem::path& folder, const std::string& stem,
                                 std::span<const float> values, const AoSceneTruth& truth, int width,
                                 int height) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  std::string name = stem;
  std::replace(name.begin(), name.end(), ' ', '_');
  if (auto done = io::write_png(folder / (name + "_truth.png"), truth_picture(truth, width, height)); !done)
    return done;
  if (auto done = io::write_png(folder / (name + "_value.png"), openness_picture(values, width, height));
      !done)
    return done;
  return io::write_png(folder / (name + "_error.png"), error_picture(values, truth, width, height));
}

}  // namespace tenebra::bench
