// Linear colour to the 8 bits of a picture.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/material.h>

namespace tenebra::shade {

/// The level of a value in 0..1 is that of its bucket, or the next one from the bucket's threshold on: no
/// bucket holds two thresholds. Buckets are 128 to an octave: the upper bits of a float.
struct LevelTable {
  static constexpr int shift = 16;  ///< bits of a float below its bucket
  std::int32_t first = 0;           ///< upper bits of the least value that differs from 0
  std::vector<float> threshold;     ///< one for each bucket; infinite where it has none
  std::vector<std::int32_t> level;  ///< one for each bucket
};

/// Levels 0 to 255, rounded to the nearest: srgb by the curve of IEC 61966-2-1, display in proportion. The
/// thresholds are exact but for their own rounding to float. Made once; any thread may ask.
const LevelTable& level_table(Transfer transfer);

/// The level of one value, which is clamped to 0..1; NaN gives 0.
std::uint8_t encode(const LevelTable& table, float value);

}  // namespace tenebra::shade
