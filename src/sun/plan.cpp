#include "sun/plan.h"

#include <fmt/format.h>
#include <stb/stb_easy_font.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tenebra::sun {
namespace {

// Pixels.
constexpr int edge = 16, bar_width = 20, dot = 2, letter_height = 7 * dot, letter_step = 7 * dot;
constexpr int legend_width = 3 * edge / 2 + bar_width + 13 * letter_step, least_height = 160;
constexpr glm::vec3 black(0);

class Canvas {
public:
  Canvas(int width, int height)
      : image_{width, height, 3, std::vector<std::uint8_t>(std::size_t{3} * width * height, 255)} {}
  void fill(int x, int y, int width, int height, const glm::vec3& colour) {
    for (int row = y; row < std::min(y + height, image_.height); ++row)
      for (int column = x; column < std::min(x + width, image_.width); ++column)
        for (int c = 0; c < 3; ++c)
          image_.pixels[3 * (static_cast<std::size_t>(row) * image_.width + column) + c] =
              static_cast<std::uint8_t>(std::lround(255 * colour[c]));
  }
  void write(int x, int y, std::string text) {
    struct Corner {
      float x, y, z;
      std::uint32_t colour;
    };
    std::array<Corner, 4096> corners;  // some 17 for each letter
    const int quads =
        stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(), static_cast<int>(sizeof corners));
    const auto pixel = [](float at) { return dot * static_cast<int>(at); };
    for (int q = 0; q < quads; ++q) {
      const Corner &low = corners[static_cast<std::size_t>(4 * q)],
                   &high = corners[static_cast<std::size_t>(4 * q + 2)];
      fill(x + pixel(low.x), y + pixel(low.y), pixel(high.x) - pixel(low.x), pixel(high.y) - pixel(low.y),
           black);
    }
  }
  io::Image8 take() { return std::move(image_); }

private:
  io::Image8 image_;
};

/// The largest of 1, 2, 5, 10, 20 .. times a power of ten that is at most `length`.
double round_length(double length) {
  const double ten = std::pow(10, std::floor(std::log10(length)));
  return length >= 5 * ten ? 5 * ten : length >= 2 * ten ? 2 * ten : ten;
}

void draw_legend(Canvas& canvas, int x, int height, const Study& study, const ColourScale& scale) {
  for (int row = 0; row < height; ++row)
    canvas.fill(x, edge + row, bar_width, 1, scale(scale.most * (1 - (row + 0.5) / height)));
  constexpr int labels = 4;
  const std::string unit = quantity_of(study.suns).unit;
  for (int i = 0; i <= labels; ++i) {
    const int y = edge + (height - letter_height) * (labels - i) / labels;
    canvas.write(x + bar_width + edge / 2, y, fmt::format("{:.4g} {}", scale.most * i / labels, unit));
  }
}

}  // namespace

io::Image8 plan_of(const Study& study, const ColourScale& scale) {
  const Grid& grid = study.receivers.grid;
  const int side = std::clamp(800 / std::max(grid.columns, grid.rows), 1, 32);  // of a cell
  const int width = grid.columns * side, height = std::max(grid.rows * side, least_height);
  Canvas canvas(edge + width + legend_width, 3 * edge + height + letter_height);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      canvas.fill(edge + column * side, edge + row * side, side, side,
                  scale(value_of(study, static_cast<std::size_t>(row) * grid.columns + column)));
  draw_legend(canvas, edge + width + edge, std::min(height, 400), study, scale);
  const double metres = round_length(std::max(grid.columns * grid.cell_m / 3, grid.cell_m));
  const int length = std::max(1, static_cast<int>(std::lround(metres / grid.cell_m * side)));
  const int y = 2 * edge + height;
  canvas.fill(edge, y + letter_height / 2 - 1, length, 3, black);
  for (const int x : {edge, edge + length - 2}) canvas.fill(x, y, 2, letter_height, black);
  canvas.write(edge + length + edge / 2, y, fmt::format("{:.6g} m", metres));
  return canvas.take();
}

}  // namespace tenebra::sun
