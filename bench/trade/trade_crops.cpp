#include "bench/trade/trade_crops.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tenebra::bench {
namespace {

constexpr double error_gain = 16;
constexpr std::size_t gap = 4;  // pixels between squares

std::uint8_t encoded(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  const double srgb = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

/// Squares in a grid on white.
class Sheet {
public:
  Sheet(std::size_t side, std::size_t columns, std::size_t rows) : side_(side) {
    image_.width = static_cast<int>(columns * (side + gap) - gap);
    image_.height = static_cast<int>(rows * (side + gap) - gap);
    image_.pixels.assign(static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height),
                         255);
  }

  /// `value(x, y)`: of a pixel of the square.
  template <class Value>
  void put(std::size_t column, std::size_t row, const Value& value) {
    const std::size_t x0 = column * (side_ + gap), y0 = row * (side_ + gap);
    for (std::size_t y = 0; y < side_; ++y)
      for (std::size_t x = 0; x < side_; ++x)
        image_.pixels[(y0 + y) * static_cast<std::size_t>(image_.width) + x0 + x] = value(x, y);
  }
  const io::Image8& image() const { return image_; }

private:
  std::size_t side_;
  io::Image8 image_;
};

/// Large where errors are large and little else is to be seen.
double plainness(const CropPlace& place, std::span<const float> errors, std::span<const float> picture) {
  const auto square = [](float value) { return static_cast<double>(value) * static_cast<double>(value); };
  const double level = 1.0 / 255;  // what a picture of 8 bits does not show is no step
  double error = 0, steps = level * level * static_cast<double>(place.side * place.side);
  for (std::size_t row = 1; row < place.side; ++row) {
    for (std::size_t column = 1; column < place.side; ++column) {
      const std::size_t i = place.pixel(column, row);
      error += square(errors[i]);
      steps += square(picture[i] - picture[i - 1]) + square(picture[i] - picture[i - place.width]);
    }
  }
  return error / std::sqrt(steps);
}

}  // namespace

std::vector<const TradePoint*> crop_settings(const std::vector<TradePoint>& points,
                                             std::span<const char* const> families) {
  std::vector<const TradePoint*> chosen;
  for (const double aim : {0.5, 2.0, 8.0}) {
    const auto off = [&](const TradePoint& p) { return std::abs(std::log(p.errors[0] / aim)); };
    const TradePoint* nearest = nullptr;
    for (const TradePoint& p : points) {
      if (std::find(families.begin(), families.end(), p.family) == families.end() || !(p.errors[0] > 0))
        continue;
      if (nearest == nullptr || off(p) < off(*nearest)) nearest = &p;
    }
    if (nearest != nullptr && std::find(chosen.begin(), chosen.end(), nearest) == chosen.end())
      chosen.push_back(nearest);
  }
  return chosen;
}

CropPlace plainest_place(std::span<const float> errors, std::span<const float> picture, std::size_t width,
                         std::size_t side) {
  const std::size_t height = errors.size() / width;
  side = std::min({side, width, height});
  const std::size_t step = std::max<std::size_t>(1, side / 6);
  CropPlace plainest{width, 0, 0, side};
  double most = -1;
  for (std::size_t y = 0; y + side <= height; y += step) {
    for (std::size_t x = 0; x + side <= width; x += step) {
      const CropPlace place{width, x, y, side};
      const double plain = plainness(place, errors, picture);
      if (plain > most) most = plain, plainest = place;
    }
  }
  return plainest;
}

TradeCrops make_crops(const CropPlace& place, std::span<const float> exact,
                      std::span<const CropPicture> pictures) {
  Sheet sheet(place.side, 1 + pictures.size(), 2);
  const auto show = [&](std::size_t column, std::span<const float> values) {
    sheet.put(column, 0, [&](std::size_t x, std::size_t y) {
      return encoded(static_cast<double>(values[place.pixel(x, y)]));
    });
  };
  show(0, exact);
  std::string caption = "exact";
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const CropPicture& picture = pictures[i];
    show(i + 1, picture.values);
    sheet.put(i + 1, 1, [&](std::size_t x, std::size_t y) {
      const std::size_t pixel = place.pixel(x, y);
      const double error = std::abs(static_cast<double>(picture.values[pixel] - exact[pixel]));
      // In sixteen steps: noise in more of them makes large files.
      return static_cast<std::uint8_t>(17 * std::lround(15 * std::min(1.0, error_gain * error)));
    });
    caption +=
        fmt::format("; {}: {} /255", picture.setting->name(), short_number(picture.setting->errors[0]));
  }
  return {sheet.image(), caption};
}

}  // namespace tenebra::bench
