// Shades samples, one block of neighbours after another. Internal to shade; each thread has its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shade/kernels.h"
#include "shade/shading.h"

namespace tenebra::shade {

/// What all blocks of a frame share.
struct FrameTerms {
  FrameTerms(const Subject& of, const Lighting& lit_by);

  Subject subject;
  Lighting lighting;
  std::vector<LightTerms> lights;
  glm::vec3 ambient_light{1.0f};  ///< with an environment: 1, and it is multiplied in later
  std::vector<Surface> surfaces;  ///< ambient times the ambient light
  Kernels code;
};

class BlockShader {
public:
  /// `width_px`: as Samples::width_px.
  explicit BlockShader(const FrameTerms& frame, float width_px = 1) : frame_(frame), width_px_(width_px) {}

  /// Begins a block of up to SampleBlock::capacity samples at window places (x, y), arrays of
  /// SampleBlock::room. Ids beyond the triangles are background.
  void place(std::span<const std::uint32_t> ids, const float* x, const float* y);

  /// The block's linear colours. Its samples begin at `first` in the factors and the openness (empty: 1).
  void shade(std::span<const LightFactors> factors, std::span<const float> openness, std::size_t first);
  /// One light alone, before shadows.
  void shade_light(std::size_t light);

  const SampleBlock& block() const { return block_; }

private:
  void place_background(const float* x, const float* y, std::size_t first, std::size_t count);
  /// Textures and vertex colours, of neighbouring triangles of one material at once: `locate` begins or
  /// continues a stretch of samples, `finish` gives it its surfaces.
  void locate_run(const TriangleSetup& setup, std::size_t material, const glm::uvec3& corners,
                  std::size_t first, std::size_t count);
  void finish_stretch();
  void narrow_places(std::size_t rules);
  const texture::TextureValues* sampled(const MapUse& use, const TextureMap& map, texture::TextureValues& to);
  /// What is mirrored, and the light of an environment.
  void surround();
  void place_run(std::uint32_t id, const float* x, const float* y, std::size_t first, std::size_t count);
  void add_light(std::size_t light, const LightFactors& factors, std::size_t first);
  bool is_coloured(const TintFactors& tint, std::size_t first) const;
  void add_coloured(std::size_t light, const float* factor, std::span<const glm::vec3> tint);

  const FrameTerms& frame_;
  float width_px_;
  SetupCache setups_;
  SampleBlock block_{};
  bool anything_seen_ = false;
  alignas(64) float factor_[SampleBlock::room] = {};
  struct Stretch {
    std::size_t material = 0, first = 0, count = 0;  // count 0: none
  };
  static constexpr std::size_t most_rules = 8;  // of SurfaceMaps
  Stretch stretch_;
  texture::TexturePlaces places_[most_rules] = {};
  texture::TextureValues vertices_{}, base_values_{}, emissive_values_{}, gloss_values_{}, passing_values_{};
  texture::TextureValues specular_values_{}, share_values_{}, occlusion_values_{}, normal_values_{},
      tangents_{};
  SampleBlock::Channel before_[3] = {};  ///< colours without a coloured light
};

}  // namespace tenebra::shade
