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

}  // namespace

vec3 Environment::Level::sample(const vec3& d) const {
  const float across = std::atan2(d.x, -d.z) / (2 * std::numbers::pi_v<float>)+0.5f;
  const float down = std::acos(std::clamp(d.y, -1.0f, 1.0f)) / std::numbers::pi_v<float>;
  const float x = across * static_cast<float>(width) - 0.5f, y = down * static_cast<float>(height) - 0.5f;
  const float x0 = std::floor(x), y0 = std::floor(y);
  const auto column = static_cast<int>(x0), row = static_cast<int>(y0);
  const int left = (column + width) % width, right = (column + 1) % width;
  const int top = std::clamp(row, 0, height - 1), bottom = std::clamp(row + 1, 0, height - 1);
  return glm::mix(glm::mix(at(left, top), at(right, top), x - x0),
                  glm::mix(at(left, bottom), at(right, bottom), x - x0), y - y0);
}

Environment::Level Environment::halved(const Level& from) {
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

Environment::Level Environment::diffused(const Level& from) {
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

Environment::Environment(const base::ImageF& picture) {
  Level& all = levels_.emplace_back(Level{picture.width, picture.height, {}});
  for (std::size_t i = 0; i + 2 < picture.pixels.size(); i += 3)
    all.pixels.push_back(usable(&picture.pixels[i]));
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
  const auto small = std::find_if(levels_.begin(), levels_.end(),
                                  [](const Level& level) { return level.width <= 64 && level.height <= 32; });
  diffuse_ = diffused(*small);
}

vec3 Environment::mirrored(const vec3& direction, float roughness) const {
  const float widest = 2 * roughness * roughness;  // radians
  const float pixels = widest * static_cast<float>(levels_[0].width) / (2 * std::numbers::pi_v<float>);
  const float level =
      std::clamp(std::log2(std::max(pixels, 1.0f)), 0.0f, static_cast<float>(levels_.size() - 1));
  const auto lower = static_cast<std::size_t>(level);
  const float part = level - static_cast<float>(lower);
  const vec3 sharp = levels_[lower].sample(direction);
  return part > 0 ? glm::mix(sharp, levels_[lower + 1].sample(direction), part) : sharp;
}

vec3 Environment::diffuse(const vec3& normal) const {
  return diffuse_.sample(normal);
}

}  // namespace tenebra::shade
