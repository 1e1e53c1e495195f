// What stands around a scene, from an equirectangular picture: seen behind everything, mirrored by gloss, and
// the light that comes from all sides.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "base/image.h"

namespace tenebra::shade {

/// Radiance by direction. The picture's middle column is seen along -Z, its upper row along +Y; to the right
/// is +X. Made once; smaller copies are means of 2x2 pixels, by the solid angles of their rows.
class Environment {
public:
  /// `picture`: three channels, linear, at least 1x1; what is not finite or negative counts as 0.
  explicit Environment(const base::ImageF& picture);

  /// What a mirror of GGX roughness `roughness` (the square root of its alpha) shows in the unit direction
  /// `direction`: the copy whose pixels are as wide as the lobe, 2 alpha radians.
  glm::vec3 mirrored(const glm::vec3& direction, float roughness) const;
  /// What a white diffuse surface with the unit normal `normal` shows in the open: irradiance / pi. Within 2
  /// % of the brightest direction's of the integral over the picture's copy of at most 64x32 pixels.
  glm::vec3 diffuse(const glm::vec3& normal) const;

private:
  struct Level {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;
    const glm::vec3& at(int x, int y) const {
      return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)];
    }
    glm::vec3 sample(const glm::vec3& direction) const;
  };
  static Level halved(const Level& from);
  static Level diffused(const Level& from);

  std::vector<Level> levels_;
  Level diffuse_;
};

}  // namespace tenebra::shade
