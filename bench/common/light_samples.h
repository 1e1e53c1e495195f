// Stratified points on an area light, drawn beforehand so that the sampling contestants pay for rays only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <tenebra/area_light.h>

namespace tenebra::bench {

/// Jittered points, one in each cell of a grid of `per_pattern` cells of equal area, in `pattern_count`
/// independent patterns. Coordinates in world space, in separate arrays.
struct LightSamples {
  std::size_t per_pattern = 0;  ///< a power of two
  std::size_t pattern_count = 0;
  /// Sixteen patterns interleaved (`tile`) or one after another: see first().
  std::vector<float> x, y, z;
};

/// Patterns one after another: pattern p's points stand at p * per_pattern. A pattern has a multiple of
/// sixteen places; where it has fewer points than that the rest repeats the first.
LightSamples samples_by_pixel(const AreaLight& light, std::size_t per_pattern, std::size_t pattern_count);

/// Sixteen patterns side by side, one per lane: the points of cell s of block b (sixteen patterns) stand at
/// (b * per_pattern + s) * 16 + lane. `pattern_count` is a multiple of sixteen.
LightSamples samples_by_tile(const AreaLight& light, std::size_t per_pattern, std::size_t pattern_count);

/// The same layout, of Sobol's sequence in place of jittered cells, each pattern scrambled by itself (Owen
/// 1995, by the hash of Laine and Karras 2011): any first 2^m points of a pattern are stratified.
LightSamples sobol_by_tile(const AreaLight& light, std::size_t per_pattern, std::size_t pattern_count);

/// Well mixed bits of a pixel's or tile's number: neighbours get unrelated patterns.
std::size_t scattered(std::size_t number);

}  // namespace tenebra::bench
