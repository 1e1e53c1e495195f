// Data about the visible surfaces in addition to their colours: pictures for compositing and denoising.
// FrameResult has them for callers of Renderer, and OpenEXR files (--aov) are written from them.
#pragma once

#include <cstdint>
#include <vector>

#include "io/image.h"

namespace tenebra::render {

/// Which of them are wanted. The others cost neither time nor memory.
struct AovChoice {
  bool depth = false;
  bool ids = false;
  bool normal = false;
  bool visibility = false;  ///< needs shadows
  bool irradiance = false;
  bool openness = false;  ///< needs ambient occlusion
  bool albedo = false;

  bool any() const { return depth || ids || normal || visibility || irradiance || openness || albedo; }
};

/// How much of a light each pixel sees, behind opaque casters: its mask, whatever found it.
struct LightVisibility {
  int light = -1;       ///< as LightMask::light
  io::ImageF fraction;  ///< 0 to 1; of a light without an area 0 or 1; 0: background
};

/// Data of the opaque surface that each pixel's centre sees; nothing is smoothed. Each is of the frame's
/// size, row 0 at the top: one value per pixel, or three (normal, irradiance, albedo). Empty where not
/// wanted.
struct Aovs {
  io::ImageF depth;                ///< metres along the view axis from the eye's plane; infinite: background
  std::vector<std::uint32_t> ids;  ///< triangle, its index in FrameGeometry; no_triangle: background
  std::vector<std::uint32_t> parts;      ///< likewise: which of FrameGeometry::parts, a mesh at its node
  std::vector<std::uint32_t> materials;  ///< likewise: index into Scene::materials
  io::ImageF normal;  ///< shading normal, unit, in world space, to the eye's side; 0: background
  std::vector<LightVisibility> visibility;  ///< one for each of FrameResult::masks
  io::ImageF irradiance;  ///< RGB of all lights with their shadows, without ambient light: lux, or for
                          ///< lights without units (BART) intensity times the cosine
  io::ImageF openness;    ///< ambient occlusion: 1 open to 0 closed; 1: background
  io::ImageF albedo;      ///< RGB: the base colour with its textures and the vertices' colours; 0: background
};

}  // namespace tenebra::render
