#include "bench/soft/soft_pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "io/image.h"

namespace tenebra::bench {
namespace {

std::uint8_t encoded(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  const double srgb = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

Expected<void> write_irradiance(std::span<const float> irradiance, double white, int width, int height,
                                const std::filesystem::path& path) {
  io::Image8 image{width, height, 1, {}};
  for (const float e : irradiance) image.pixels.push_back(encoded(static_cast<double>(e) / white));
  return io::write_png(path, image);
}

}  // namespace

Expected<void> write_pictures(const Contest& contest, int width, int height,
                              const std::filesystem::path& folder) {
  std::string stem = contest.view;
  std::replace(stem.begin(), stem.end(), ' ', '_');
  const auto ours = folder / (stem + "_tenebra.png");
  if (auto done = write_irradiance(contest.tenebra, contest.white, width, height, ours); !done) return done;
  const auto theirs = folder / fmt::format("{}_embree_{}_rays.png", stem, contest.equal_time.rays);
  return write_irradiance(contest.embree_equal_time, contest.white, width, height, theirs);
}

}  // namespace tenebra::bench
