// A picture with its smaller copies, and what a pixel of the screen sees of it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/material.h>

namespace tenebra::texture {

/// What the values of a picture are.
enum class Content {
  srgb_color,        ///< encoded by the sRGB curve; decoded where it is read and averaged
  srgb_beside_data,  ///< the same, beside an alpha that is no share of a surface
  display_color,     ///< taken as they are
  data               ///< taken as they are, alpha too
};

/// The pixel's footprint: what the texture coordinates, before TextureMap::transform, change by from this
/// pixel to the next in x and in y.
struct Footprint {
  glm::vec2 dx{0.0f};
  glm::vec2 dy{0.0f};
};

/// Level 0 is the picture; each next level is half as wide and half as high, rounded down, to 1x1. A pixel of
/// it is the mean of what it covers, of odd sizes in proportion, in linear light; colours count by their
/// alpha, so that what is see-through does not shine through. Levels above 0 are kept at 8 bits too, rounded
/// once from floats.
class MipTexture {
public:
  static constexpr int most_taps = 16;

  MipTexture(const TextureImage& image, Content content);

  /// The texture's four values at `uv`, 0 to 1, colours linear: of level 0 by `magnify` where the picture is
  /// enlarged; else by `minify` and `mip` from as many places along the longer axis of the footprint as it
  /// is longer than the shorter one, at most `most_taps`, each as large as the shorter axis. Coordinates that
  /// are not finite give the first pixel.
  glm::vec4 sample(const TextureMap& map, glm::vec2 uv, const Footprint& footprint) const;

  std::size_t level_count() const { return levels_.size(); }
  int width(std::size_t level = 0) const { return levels_[level].width; }
  int height(std::size_t level = 0) const { return levels_[level].height; }
  glm::vec4 pixel(std::size_t level, int x, int y) const;  ///< linear

private:
  glm::vec4 decoded(const std::uint8_t* rgba) const {
    return {decode_[rgba[0]], decode_[rgba[1]], decode_[rgba[2]],
            static_cast<float>(rgba[3]) * (1.0f / 255.0f)};
  }
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
  };
  glm::vec4 at_level(std::size_t level, Filter filter, const TextureMap& map, const glm::dvec2& place) const;
  glm::vec4 at_detail(const TextureMap& map, float detail, const glm::dvec2& place) const;

  std::vector<Level> levels_;
  const float* decode_;  // of 256 levels of colour
};

}  // namespace tenebra::texture
