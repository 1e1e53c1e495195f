#include "bench/ao/scenes/ao_scene_errors.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace tenebra::bench {

std::vector<double> pixel_errors(std::span<const float> values, const AoSceneTruth& truth) {
  std::vector<double> errors;
  errors.reserve(truth.pixels.size());
  for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
    const float value = values[truth.pixels[k]];
    const bool fine = value >= 0 && value <= 1;
    errors.push_back(fine ? 255 * std::abs(double{value} - double{truth.open[k]}) : 255.0);
  }
  return errors;
}

AoSceneErrors scene_errors(std::span<const float> values, const AoSceneTruth& truth) {
  std::vector<double> errors = pixel_errors(values, truth);
  if (errors.empty()) return {};
  const double squares = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
  const auto count = static_cast<double>(errors.size());
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.99 * count)) - 1;
  std::nth_element(errors.begin(), errors.begin() + rank, errors.end());
  const double p99 = errors[static_cast<std::size_t>(rank)];
  return {std::sqrt(squares / count), p99, *std::max_element(errors.begin() + rank, errors.end())};
}

std::vector<WorstPixel> worst_pixels(std::span<const float> values, const AoSceneTruth& truth, int width,
                                     int count, int apart) {
  const std::vector<double> errors = pixel_errors(values, truth);
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  const auto near = [&](std::size_t a, std::size_t b) {
    const auto x = [&](std::size_t i) { return static_cast<int>(i % static_cast<std::size_t>(width)); };
    const auto y = [&](std::size_t i) { return static_cast<int>(i / static_cast<std::size_t>(width)); };
    return std::abs(x(a) - x(b)) <= apart && std::abs(y(a) - y(b)) <= apart;
  };
  std::vector<WorstPixel> worst;
  for (const std::size_t k : order) {
    if (static_cast<int>(worst.size()) == count) break;
    const std::size_t pixel = truth.pixels[k];
    const bool known =
        std::any_of(worst.begin(), worst.end(), [&](const WorstPixel& w) { return near(w.pixel, pixel); });
    if (!known) worst.push_back({pixel, values[pixel], truth.open[k]});
  }
  return worst;
}

}  // namespace tenebra::bench
