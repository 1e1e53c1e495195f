// Kernels for a block of samples, sixteen at a time. Internal to shade.
#pragma once

#include <tenebra/simd_level.h>
#include "shade/display.h"
#include "shade/encoder.h"
#include "shade/light_terms.h"
#include "shade/panorama.h"
#include "shade/sample_block.h"
#include "shade/surfaces.h"
#include "shade/triangle_setup.h"
#include "texture/sampler.h"

namespace tenebra::shade {

static_assert(SampleBlock::room == texture::TexturePlaces::room);

/// What a material's factors are multiplied with at each sample; null: 1.
struct SurfaceInputs {
  const texture::TextureValues* vertices = nullptr;
  const texture::TextureValues* base = nullptr;
  const texture::TextureValues* emissive = nullptr;
  const texture::TextureValues* gloss = nullptr;
  const texture::TextureValues* specular = nullptr;
  const texture::TextureValues* specular_share = nullptr;
  const texture::TextureValues* transmission = nullptr;
  const texture::TextureValues* occlusion = nullptr;
};

/// Code for one instruction set; all give the same bits.
struct Kernels {
  // These fill samples `first` ... `first + count - 1`, and may write up to fifteen samples behind them.

  /// Places and normals at window places (x, y), all of one triangle.
  void (*place)(const TriangleSetup& setup, bool smooth_terminator, const float* x, const float* y,
                std::size_t first, std::size_t count, SampleBlock& block) = nullptr;
  /// Puts one surface on all samples.
  void (*cover)(const Surface& surface, std::size_t first, std::size_t count, SampleBlock& block) = nullptr;
  /// Places on textures, of placed samples of one triangle.
  void (*locate)(const TriangleSetup& setup, const CoordinatePlane& plane, const SampleBlock& block,
                 std::size_t first, std::size_t count, texture::TexturePlaces& places) = nullptr;
  /// Between four values of each of a triangle's vertices.
  void (*blend)(const glm::vec4* colors, const SampleBlock& block, std::size_t first, std::size_t count,
                texture::TextureValues& out) = nullptr;
  /// The surface of a material with its textures.
  void (*resolve)(const Material& material, const SurfaceInputs& inputs, const glm::vec3& ambient_light,
                  std::size_t first, std::size_t count, SampleBlock& block) = nullptr;
  /// Bends the shading normals by a normal map. `tangents`: as corner_tangents() has them.
  void (*bend)(float scale, const texture::TextureValues& map, const texture::TextureValues& tangents,
               std::size_t first, std::size_t count, SampleBlock& block) = nullptr;
  texture::Sampler sample = nullptr;

  /// Fills to_eye; `towards`: the same unit direction for all (orthographic views), or null.
  void (*look)(const glm::vec3* towards, SampleBlock& block) = nullptr;
  /// Fills reflected where the surroundings are the same on all sides but for `brighter`, which smooth
  /// surfaces see more of.
  void (*reflect)(const glm::vec3& around, const glm::vec3& brighter, SampleBlock& block) = nullptr;
  /// What is seen of the surroundings in the unit directions `towards`, through lobes of `roughness` (null:
  /// 0).
  void (*see)(const Panorama& picture, const SampleBlock::Channel (&towards)[3], const float* roughness,
              std::size_t first, std::size_t count, SampleBlock::Channel (&out)[3]) = nullptr;
  /// Ambient and reflected light from `irradiance` and `radiance` all around.
  void (*surround)(const Panorama& irradiance, const Panorama& radiance, SampleBlock& block) = nullptr;
  /// color = ambient * occlusion * openness + emissive; `openness`: one for each sample, or null: all open.
  /// Glossy samples also mirror `reflected`, times their openness.
  void (*begin)(const float* openness, SampleBlock& block) = nullptr;
  /// Adds a light; `factor`: one for each sample, or null: 1.
  void (*light)(const LightTerms& terms, const float* factor, SampleBlock& block) = nullptr;
  /// color as it is shown (shade/display.h), 0 to 1.
  void (*show)(const Display& display, SampleBlock& block) = nullptr;
  /// What is shown of color as levels, three for each sample; `table`: of display.transfer.
  void (*encode)(const LevelTable& table, const Display& display, const SampleBlock& block,
                 std::uint8_t* rgb) = nullptr;
};
Kernels kernels(SimdLevel level);

}  // namespace tenebra::shade
