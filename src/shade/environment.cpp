#include "shade/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tenebra::shade {
namespace {

using glm::vec3;
constexpr double pi = std::numbers::pi;

/// Solid angle of a pixel in row `y` of `height`, but for a factor that all pixels of a picture share.
double row_weight(int y, int height) {
  return std::cos(pi * y / height) - std::cos(pi * (y + 1) / height);
}

vec3 direction_of(int x, int y, int width, int height) {
  const double across = 2 * pi * ((x + 0.5) / width - 0.5), down = pi * (y + 0.5) / height;
  return {std::sin(down) * std::sin(across), std::cos(down), -std::sin(down) * std::cos(across)};
}

vec3 usable(const float* rgb) {
  const auto one = [](float v) { return v > 0 && std::isfinite(v) ? v : 0.0f; };
  return {one(rgb[0]), one(rgb[1]), one(rgb[2])};
}

struct Level {
  int width = 0, height = 0;
  std::vector<vec3> pixels;
  const vec3& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

Level halved(const Level& from) {
  Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
  for (int y = 0; y < to.height; ++y) {
    const int first_row = y * from.height / to.height, last_row = (y + 1) * from.height / to.height;
    for (int x = 0; x < to.width; ++x) {
      const int first = x * from.width / to.width, last = (x + 1) * from.width / to.width;
      glm::dvec3 sum(0.0);
      double weights = 0;
      for (int row = first_row; row < last_row; ++row) {
        const double weight = row_weight(row, from.height);
        for (int column = first; column < last; ++column) {
          sum += weight * glm::dvec3(from.at(column, row));
          weights += weight;
        }
      }
      to.pixels.emplace_back(sum / weights);
    }
  }
  return to;
}

Level diffused(const Level& from) {
  Level to{32, 16, {}};
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      const vec3 normal = direction_of(x, y, to.width, to.height);
      glm::dvec3 sum(0.0);
      double weights = 0;  // divided by, so that uniform light stays as it is
      for (int row = 0; row < from.height; ++row) {
        for (int column = 0; column < from.width; ++column) {
          const float cosine = glm::dot(normal, direction_of(column, row, from.width, from.height));
          if (!(cosine > 0)) continue;
          const double weight = cosine * row_weight(row, from.height);
          sum += weight * glm::dvec3(from.at(column, row));
          weights += weight;
        }
      }
      to.pixels.emplace_back(weights > 0 ? sum / weights : sum);
    }
  }
  return to;
}

void add_level(const Level& level, Panorama& to) {
  if (to.level_count == 0) to.width = level.width, to.height = level.height;
  const int stride = level.width + 2;
  to.starts[static_cast<std::size_t>(to.level_count++)] =
      static_cast<std::int32_t>(to.pixels.size()) + stride + 1;
  for (int y = -1; y <= level.height; ++y) {
    for (int x = -1; x <= level.width; ++x)
      to.pixels.emplace_back(level.at((x + level.width) % level.width, std::clamp(y, 0, level.height - 1)),
                             0.0f);
  }
}

}  // namespace

Environment::Environment(const io::ImageF& picture) {
  Level level{picture.width, picture.height, {}};
  for (std::size_t i = 0; i + 2 < picture.pixels.size(); i += 3)
    level.pixels.push_back(usable(&picture.pixels[i]));
  for (;; level = halved(level)) {
    add_level(level, radiance_);
    const bool small = level.width <= 64 && level.height <= 32;
    if (small && irradiance_.level_count == 0) add_level(diffused(level), irradiance_);
    if (level.width == 1 && level.height == 1) break;
  }
}

}  // namespace tenebra::shade
