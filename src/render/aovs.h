// What a frame knows of the surfaces that are seen, beside their colours: pictures for compositing and
// denoising.
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace tenebra::render {

/// Which of them are wanted.
struct AovChoice {
  bool depth = false;
  bool ids = false;
  bool normal = false;
  bool irradiance = false;
  bool openness = false;  ///< needs ambient occlusion
  bool albedo = false;

  bool any() const { return depth || ids || normal || irradiance || openness || albedo; }
};

/// Of the opaque surface that each pixel's centre sees; nothing is smoothed. Empty where not wanted.
struct Aovs {
  base::ImageF depth;              ///< metres along the view axis from the eye's plane; infinite: background
  std::vector<std::uint32_t> ids;  ///< triangle, its index in FrameGeometry; no_triangle: background
  std::vector<std::uint32_t> parts;      ///< likewise: which of FrameGeometry::parts, a mesh at its node
  std::vector<std::uint32_t> materials;  ///< likewise: index into Scene::materials
  base::ImageF normal;      ///< shading normal, unit, in world space, to the eye's side; 0: background
  base::ImageF irradiance;  ///< RGB of all lights with their shadows, without ambient light: lux, or for
                            ///< lights without units (BART) intensity times the cosine
  base::ImageF openness;    ///< ambient occlusion: 1 open to 0 closed; 1: background
  base::ImageF albedo;  ///< RGB: the base colour with its textures and the vertices' colours; 0: background
};

}  // namespace tenebra::render
