// An equirectangular picture with its smaller copies, as the kernels read it. Internal to shade.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tenebra::shade {

/// The middle column is seen along -Z, the upper row along +Y; to the right is +X. Each level is half as wide
/// and half as high as the one before, rounded down.
struct Panorama {
  static constexpr int most_levels = 32;

  int width = 0, height = 0, level_count = 0;  ///< of level 0
  /// With a border of one pixel: the other edge's to the left and right, the same above and below.
  std::vector<glm::vec4> pixels;
  std::array<std::int32_t, most_levels> starts{};  ///< for each level the number of its pixel (0, 0)

  int width_of(int level) const { return std::max(1, width >> level); }
  int height_of(int level) const { return std::max(1, height >> level); }
};

}  // namespace tenebra::shade
