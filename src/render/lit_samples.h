// Samples and what is left of each light at them.
#pragma once

#include <cstdint>
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
  std::vector<glm::vec3> normals;  ///< empty where nothing asks for them
  std::vector<ShadowMask> masks;   ///< of each light; empty of those with an area, and without shadows
  std::vector<std::vector<float>> irradiance;        ///< of each light; empty without an area
  std::vector<std::vector<float>> visible_fraction;  ///< likewise
  std::vector<LightTint> tints;                      ///< of each light
  std::vector<float> openness;                       ///< empty without ambient occlusion

  std::vector<shade::LightFactors> factors() const;
};

}  // namespace tenebra::render
