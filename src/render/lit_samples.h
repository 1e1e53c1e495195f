// Samples and the light that reaches them from each light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>
#include "render/light_tints.h"
#include "shade/light_terms.h"

namespace tenebra::render {

/// Samples that stand in a picture, row after row: the frame's own, for the nearest see-through surface of
/// each pixel, or one that is made of samples alone (points/sample_points.h).
struct LitSamples {
  VisiblePoints points;            ///< triangles: no_triangle where there is no sample
  VisiblePoints lifted;            ///< where they are lit, if that is on smooth surfaces
  std::vector<glm::vec3> normals;  ///< empty where nothing asks for them
  std::vector<ShadowMask> masks;   ///< of each light; empty of those with an area, and without shadows
  std::vector<std::vector<float>> irradiance;        ///< of each light; empty without an area
  std::vector<std::vector<float>> visible_fraction;  ///< likewise
  std::vector<LightTint> tints;                      ///< of each light
  std::vector<float> openness;                       ///< empty without ambient occlusion

  /// Room for this many lights, of which nothing is known yet; `tinted`: and for the tints of this many
  /// samples.
  void begin(std::size_t lights, std::size_t tinted = 0);
  std::vector<shade::LightFactors> factors() const;
};

/// The light that reaches some of those samples, one after another.
class GatheredFactors {
public:
  GatheredFactors(std::span<const shade::LightFactors> from, std::span<const std::uint32_t> samples);
  /// Masks of those lights that have one in `from`, by LitBits of each sample (antialias/centre_shadows.h).
  static GatheredFactors of_bits(std::span<const shade::LightFactors> from,
                                 std::span<const std::uint32_t> bits);
  std::vector<shade::LightFactors> factors() const;

private:
  GatheredFactors() = default;
  struct OfLight {
    std::vector<std::uint8_t> mask;
    std::vector<float> irradiance;
    std::vector<glm::vec3> tint;
    std::vector<std::uint8_t> coloured;
  };
  std::vector<OfLight> lights_;
};

}  // namespace tenebra::render
