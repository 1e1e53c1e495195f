// A picture with its smaller copies, as sampler.h reads it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/material.h>

namespace tenebra::texture {

/// What the values of a picture are.
enum class Content {
  srgb_color,        ///< encoded by the sRGB curve; decoded here
  srgb_beside_data,  ///< the same, beside an alpha that is no share of a surface
  display_color,     ///< taken as they are
  data,              ///< taken as they are, alpha too
  normal             ///< directions, each component from 0 to 1 for -1 to 1
};

/// Level 0 is the picture; each next level is half as wide and half as high, rounded down, to 1x1. A pixel of
/// it is the mean of what it covers, of odd sizes in proportion, in linear light; colours count by their
/// alpha, so that what is see-through does not shine through, and means of directions are made unit again.
/// All levels are kept linear, at 16 bits, rounded once, and with a border of one pixel: what stands beyond
/// the edges by the two ways to wrap.
class MipTexture {
public:
  static constexpr int most_levels = 32;
  static constexpr float one = 65535;  ///< the stored value of 1

  MipTexture(const TextureImage& image, Content content, Wrap wrap_u, Wrap wrap_v);

  int level_count() const { return level_count_; }
  int width(int level = 0) const { return std::max(1, width_ >> level); }
  int height(int level = 0) const { return std::max(1, height_ >> level); }
  Wrap wrap_u() const { return wrap_u_; }
  Wrap wrap_v() const { return wrap_v_; }
  glm::vec4 pixel(int level, int x, int y) const;  ///< linear, 0 to 1; x from -1 to the width, y likewise

  /// The pixels, four values each. Rows of a level stand `width + 2` pixels apart.
  const std::uint16_t* texels() const { return texels_.data(); }
  /// For each level the number of its pixel (0, 0).
  const std::array<std::int32_t, most_levels>& starts() const { return starts_; }

private:
  struct FloatLevel;
  void store(const FloatLevel& level, Content content);
  void add_border(int level);
  std::uint16_t* texel(int level, int x, int y);

  int width_ = 0, height_ = 0, level_count_ = 0;
  Wrap wrap_u_, wrap_v_;
  std::vector<std::uint16_t> texels_;
  std::array<std::int32_t, most_levels> starts_{};
};

}  // namespace tenebra::texture
