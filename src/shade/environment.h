// The surroundings of a scene, from an equirectangular picture: seen behind everything, mirrored by gloss,
// and the source of light from all sides.
#pragma once

#include "io/image.h"
#include "shade/panorama.h"

namespace tenebra::shade {

/// Radiance by direction. Made once; smaller copies are means of 2x2 pixels, by the solid angles of their
/// rows.
class Environment {
public:
  /// `picture`: three channels, linear, at least 1x1; what is not finite or negative counts as 0.
  explicit Environment(const io::ImageF& picture);

  /// What is seen, and mirrored: from the copy whose pixels are as wide as the lobe.
  const Panorama& radiance() const { return radiance_; }
  /// What a white diffuse surface with a normal in that direction shows in the open: irradiance / pi. It
  /// differs from the integral over the picture's copy of at most 64x32 pixels by at most 2 % of the value in
  /// the brightest direction.
  const Panorama& irradiance() const { return irradiance_; }

private:
  Panorama radiance_, irradiance_;
};

}  // namespace tenebra::shade
