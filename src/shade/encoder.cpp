#include "shade/encoder.h"

#include <bit>
#include <cmath>
#include <limits>

#include "math/srgb.h"

namespace tenebra::shade {
namespace {

double value_of_level(Transfer transfer, double level) {
  const double y = level / 255.0;
  if (transfer == Transfer::display) return y;
  return math::linear_of_srgb(y);
}

/// The least float that is `value` or more.
float ceiling(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest < value ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

LevelTable make_table(Transfer transfer) {
  LevelTable table;
  const auto bucket_of = [&](float value) {
    return (std::bit_cast<std::int32_t>(value) >> LevelTable::shift) - table.first;
  };
  table.first = bucket_of(ceiling(value_of_level(transfer, 0.5)));
  const auto buckets = static_cast<std::size_t>(bucket_of(1.0f)) + 1;
  table.threshold.assign(buckets, std::numeric_limits<float>::infinity());
  table.level.assign(buckets, 0);
  for (int level = 1; level <= 255; ++level) {
    const float threshold = ceiling(value_of_level(transfer, level - 0.5));
    const auto bucket = static_cast<std::size_t>(bucket_of(threshold));
    table.threshold[bucket] = threshold;
    for (std::size_t above = bucket + 1; above < buckets; ++above) table.level[above] = level;
  }
  return table;
}

}  // namespace

const LevelTable& level_table(Transfer transfer) {
  static const LevelTable srgb = make_table(Transfer::srgb), display = make_table(Transfer::display);
  return transfer == Transfer::srgb ? srgb : display;
}

std::uint8_t encode(const LevelTable& table, float value) {
  const float clamped = value > 0 ? std::min(value, 1.0f) : 0.0f;
  const std::int32_t bucket = (std::bit_cast<std::int32_t>(clamped) >> LevelTable::shift) - table.first;
  if (bucket < 0) return 0;
  const auto i = static_cast<std::size_t>(bucket);
  return static_cast<std::uint8_t>(table.level[i] + (clamped >= table.threshold[i] ? 1 : 0));
}

}  // namespace tenebra::shade
