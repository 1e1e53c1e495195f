// Alpha as a function of the plane: what a texture's pixels, and how it is wrapped, say between them.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include <tenebra/material.h>

namespace tenebra::stage {

/// Where alpha changes from one square to the next it does so over twice this, in pixels: outlines run along
/// the pixels' edges no farther from them, and do not touch where pixels meet at a corner.
inline constexpr double edge_width = 1.0 / 128;

/// Alpha of a picture's pixels, 0 to 255, or of a smaller copy of it. Level 0 is the picture; each further
/// one is half as wide and high (rounded up), its pixels the means of up to four.
struct AlphaGrid {
  int width = 0;
  int height = 0;
  std::vector<float> alpha;  ///< row by row
  bool in_squares = false;   ///< a place has the alpha of the pixel that it lies in, not one between pixels
};
AlphaGrid alpha_of(const TextureImage& image, Filter filter);
AlphaGrid half_of(const AlphaGrid& grid);

/// Values where grid lines cross, bilinear between them. Coordinates are in pixels of the grid, (0,0) the
/// centre of the first.
struct AlphaSheet {
  std::vector<double> xs, ys;  ///< ascending, at least two
  std::vector<float> values;   ///< row by row, one for each pair of lines

  float value(std::size_t column, std::size_t row) const { return values[row * xs.size() + column]; }
};

/// How copies of one sheet fill an axis of the plane: side by side from `first` on, every other one reflected
/// where `mirrored`. Period 0: the sheet is all there is.
struct AxisTiling {
  double first = 0;
  double period = 0;
  bool mirrored = false;
};

/// One period of the grid as `map` wraps it. Where it is clamped, the sheet ends at 2^33.
struct TiledSheet {
  AlphaSheet sheet;
  std::array<AxisTiling, 2> tiling;
};
TiledSheet wrap_sheet(const AlphaGrid& grid, Wrap wrap_u, Wrap wrap_v);

/// A sheet of any function.
AlphaSheet sample_sheet(std::vector<double> xs, std::vector<double> ys,
                        const std::function<double(double x, double y)>& value);

/// The grid's value at a place, as the maps wrap: of its square, or bilinear, in double.
double sample_alpha(const AlphaGrid& grid, Wrap wrap_u, Wrap wrap_v, glm::dvec2 place);

}  // namespace tenebra::stage
