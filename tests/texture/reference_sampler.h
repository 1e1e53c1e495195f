// What a pixel sees of a texture, by the definition, one pixel at a time and in double: what the sampler is
// compared with. Shares no code with it; the levels' pixels are MipTexture's.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "texture/mip_texture.h"

namespace tenebra::texture {

/// A pixel's place on a picture, and what it changes by from pixel to pixel.
struct SeenPlace {
  glm::dvec2 at{0.0}, by_x{0.0}, by_y{0.0};
};

class ReferenceSampler {
public:
  ReferenceSampler(const MipTexture& texture, const TextureMap& map) : texture_(texture), map_(map) {}

  glm::dvec4 sample(const SeenPlace& seen) const {
    const glm::dvec2 size = this->size();
    const glm::dmat2 steps = pixels(seen);
    const double longer = axes(steps).x;
    if (!(longer > 1)) return level(0, map_.magnify, seen.at);
    int taps = 1;
    if (map_.minify == Filter::linear && map_.mip != MipFilter::none && texture_.level_count() > 1)
      taps = std::clamp(static_cast<int>(std::ceil(std::min(ratio(seen), 99.0))), 1, 16);
    const double detail = std::clamp(std::log2(longer / taps), 0.0, texture_.level_count() - 1.0);
    glm::dvec4 sum(0.0);
    for (int i = 0; i < taps; ++i) {
      const glm::dvec2 offset = ((i + 0.5) / taps - 0.5) * longer * direction(steps) / size;
      sum += at_detail(detail, taps == 1 ? seen.at : seen.at + offset);
    }
    return sum / double(taps);
  }

  /// How many times the longer axis is as long as the shorter one, which counts as a pixel at least; what the
  /// number of places is rounded up from.
  double ratio(const SeenPlace& seen) const {
    const glm::dvec2 both = axes(pixels(seen));
    return both.x / std::max(both.y, 1.0) - 1e-3;
  }
  /// The longer axis, in pictures.
  double longest_step(const SeenPlace& seen) const {
    return axes(pixels(seen)).x / std::min(texture_.width(), texture_.height());
  }

private:
  glm::dvec2 size() const { return {texture_.width(), texture_.height()}; }
  glm::dmat2 pixels(const SeenPlace& seen) const { return {seen.by_x * size(), seen.by_y * size()}; }
  /// The longer and the shorter axis of the ellipse that a unit circle becomes: singular values.
  static glm::dvec2 axes(const glm::dmat2& steps) {
    const double sum = glm::dot(steps[0], steps[0]) + glm::dot(steps[1], steps[1]);
    const double determinant = std::abs(steps[0].x * steps[1].y - steps[0].y * steps[1].x);
    const double spread = std::sqrt(std::max(sum * sum - 4 * determinant * determinant, 0.0));
    const double longer = std::sqrt(0.5 * (sum + spread));
    return {longer, longer > 0 ? determinant / longer : 0};
  }
  /// Unit, along the longer axis, in pixels: by the angle whose image is longest.
  static glm::dvec2 direction(const glm::dmat2& steps) {
    const double angle = 0.5 * std::atan2(2 * glm::dot(steps[0], steps[1]),
                                          glm::dot(steps[0], steps[0]) - glm::dot(steps[1], steps[1]));
    return glm::normalize(std::cos(angle) * steps[0] + std::sin(angle) * steps[1]);
  }

  glm::dvec4 at_detail(double detail, const glm::dvec2& at) const {
    if (map_.mip == MipFilter::none) return level(0, map_.minify, at);
    if (map_.mip == MipFilter::nearest) return level(static_cast<int>(detail + 0.5), map_.minify, at);
    const int lower = static_cast<int>(detail);
    const double part = detail - lower;
    const int upper = std::min(lower + 1, texture_.level_count() - 1);
    return (1 - part) * level(lower, map_.minify, at) + part * level(upper, map_.minify, at);
  }

  glm::dvec4 level(int level, Filter filter, const glm::dvec2& at) const {
    const double shift = filter == Filter::linear ? 0.5 : 0.0;
    const double x = at.x * texture_.width(level) - shift, y = at.y * texture_.height(level) - shift;
    const double column = std::floor(x), row = std::floor(y);
    if (filter == Filter::nearest) return pixel(level, column, row);
    const double fx = x - column, fy = y - row;
    return (1 - fy) * ((1 - fx) * pixel(level, column, row) + fx * pixel(level, column + 1, row)) +
           fy * ((1 - fx) * pixel(level, column, row + 1) + fx * pixel(level, column + 1, row + 1));
  }

  glm::dvec4 pixel(int level, double column, double row) const {
    return texture_.pixel(level, wrapped(column, texture_.width(level), texture_.wrap_u()),
                          wrapped(row, texture_.height(level), texture_.wrap_v()));
  }
  static int wrapped(double i, int size, Wrap mode) {
    if (mode == Wrap::clamp_to_edge) return static_cast<int>(std::clamp(i, 0.0, size - 1.0));
    const double period = mode == Wrap::repeat ? size : 2.0 * size;
    const double within = i - period * std::floor(i / period);
    return static_cast<int>(within < size ? within : period - 1 - within);
  }

  const MipTexture& texture_;
  const TextureMap& map_;
};

}  // namespace tenebra::texture
