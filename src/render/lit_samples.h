// Samples and the light that reaches them from each light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/hard_config.h>
#include <tenebra/soft_config.h>
#include <tenebra/visible_points.h>
#include "render/light_tints.h"
#include "shade/light_terms.h"

namespace tenebra::render {

/// How much of one light reaches samples.
struct SampleLight {
  ShadowMask mask;  ///< 255 lit, 0 dark; of a light with an area 255 times the visible fraction, and at the
                    ///< pixels' centres alone; empty: nobody asked
  SoftMask soft;    ///< of a light with an area; else empty
  LightTint tint;   ///< what see-through surfaces leave of its colours

  /// The visible part of the light, 0 or 1 of one without an area.
  float visible_at(std::size_t sample) const {
    if (!soft.visible_fraction.empty()) return soft.visible_fraction[sample];
    return mask[sample] != 0 ? 1.0f : 0.0f;
  }
};

/// Samples that stand in a picture, row after row: the frame's own, for the centre or the nearest see-through
/// surface of each pixel, or one that is made of samples alone (points/sample_points.h).
struct LitSamples {
  VisiblePoints points;                             ///< triangles: no_triangle where there is no sample
  VisiblePoints lifted;                             ///< where they are lit, if that is elsewhere
  std::vector<glm::vec3> normals;                   ///< empty where nothing asks for them
  ContactRule contact = ContactRule::triangle_ids;  ///< none: the points are not exact
  std::vector<SampleLight> lights;
  std::vector<float> openness;  ///< empty without ambient occlusion

  const VisiblePoints& lit_at() const { return lifted.triangles.empty() ? points : lifted; }
  /// Room for this many lights, of which nothing is known yet; `tinted`: and for the tints of this many
  /// samples.
  void begin(std::size_t light_count, std::size_t tinted = 0);
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
