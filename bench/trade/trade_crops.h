// What errors of 0.5, 2 and 8/255 look like: pieces of pictures beside the exact one.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "bench/trade/trade_table.h"

namespace tenebra::bench {

/// A square of pixels of a picture `width` wide.
struct CropPlace {
  std::size_t width = 0, x = 0, y = 0, side = 0;

  std::size_t pixel(std::size_t column, std::size_t row) const { return (y + row) * width + x + column; }
};

/// Of `families` the settings whose first error is nearest to 0.5, 2 and 8, by ratio; each once.
std::vector<const TradePoint*> crop_settings(const std::vector<TradePoint>& points,
                                             std::span<const char* const> families);

/// Where `errors`, one per pixel, stand out most from `picture`: the largest sum of their squares over the
/// root of that of the steps between its pixels. A square of `side` pixels, or of fewer where the picture is
/// smaller.
CropPlace plainest_place(std::span<const float> errors, std::span<const float> picture, std::size_t width,
                         std::size_t side = 80);

/// A picture by one setting. Linear values, 1 is white.
struct CropPicture {
  const TradePoint* setting = nullptr;
  std::vector<float> values;
};
/// The exact picture and the others beside it, as a viewer shows them; below the others their errors,
/// 16-fold.
TradeCrops make_crops(const CropPlace& place, std::span<const float> exact,
                      std::span<const CropPicture> pictures);

}  // namespace tenebra::bench
