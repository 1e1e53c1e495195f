// Samples of one neighbourhood on their way to a colour, as the kernels read them: one value of all samples
// after another. Internal to shade.
#pragma once

#include <cstddef>

namespace tenebra::shade {

struct SampleBlock {
  static constexpr std::size_t capacity = 64;
  /// Kernels write sixteen at a time from any place on; what stands behind `count` has no meaning.
  static constexpr std::size_t room = capacity + 16;
  using Channel = float[room];

  std::size_t count = 0;
  bool keeps_gloss = false;      ///< the channels of gloss below are filled
  bool glossy = false;           ///< some sample reflects more than diffusely
  bool keeps_unbent = false;     ///< `unbent` is filled: some material has a normal map
  bool keeps_occlusion = false;  ///< `occlusion` is filled: some material has a map of it

  alignas(64) Channel u, v;        ///< weights of the triangle's second and third vertex, 0 to 1
  alignas(64) Channel depth;       ///< factor of what u and v change by from pixel to pixel
  alignas(64) Channel point[3];    ///< world axes, relative to the eye, metres
  alignas(64) Channel before[3];   ///< unit; light counts where this points to: the triangle's normal to
                                   ///< the eye's side, or the shading normal; zero: background
  alignas(64) Channel normal[3];   ///< unit shading normal, to the eye's side; normal maps bend it
  alignas(64) Channel unbent[3];   ///< the same before
  alignas(64) Channel occlusion;   ///< share of the ambient light that arrives, beside openness
  alignas(64) Channel base[3];     ///< diffuse reflectance
  alignas(64) Channel ambient[3];  ///< ambient light that is reflected where all is open
  alignas(64) Channel emissive[3];
  alignas(64) Channel alpha;  ///< share of the surface that is there

  alignas(64) Channel specular[3];   ///< Phong: reflectance; GGX: reflectance at 0 degrees
  alignas(64) Channel roughness;     ///< GGX: the square root of its alpha; negative: Phong
  alignas(64) Channel exponent;      ///< Phong
  alignas(64) Channel grazing;       ///< GGX: reflectance at 90 degrees
  alignas(64) Channel to_eye[3];     ///< unit
  alignas(64) Channel reflected[3];  ///< mirrored radiance of the surroundings, blurred by roughness

  alignas(64) Channel color[3];  ///< the result, linear
};

}  // namespace tenebra::shade
