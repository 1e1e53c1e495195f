#include "stage/cutout/alpha_sheet.h"

#include <algorithm>
#include <cmath>

#include "texture/bilinear.h"

namespace tenebra::stage {
namespace {

constexpr double far_away = 8589934592.0;  // 2^33: four times beyond what a texture coordinate may reach

/// A line across an axis, and the two pixels whose mean stands on it.
struct Line {
  double at;
  int first, second;
};

/// The lines of one period: through all pixel centres, or beside both edges of all pixels, and its two ends.
std::vector<Line> lines_of(int size, Wrap wrap, bool in_squares) {
  const int last = size - 1;
  std::vector<Line> lines;
  lines.reserve(2 * static_cast<std::size_t>(size) + 2);
  if (wrap == Wrap::clamp_to_edge) {
    lines.push_back({-far_away, 0, 0});
  } else {
    lines.push_back({-0.5, 0, wrap == Wrap::repeat ? last : 0});
  }
  const double half = in_squares ? 0.5 - edge_width : 0.0;
  for (int i = 0; i < size; ++i) {
    if (in_squares) lines.push_back({i - half, i, i});
    lines.push_back({i + half, i, i});
  }
  if (wrap == Wrap::clamp_to_edge) {
    lines.push_back({far_away, last, last});
  } else {
    lines.push_back({size - 0.5, wrap == Wrap::repeat ? 0 : last, last});
  }
  return lines;
}

AxisTiling tiling_of(int size, Wrap wrap) {
  if (wrap == Wrap::clamp_to_edge) return {-far_away, 0.0, false};
  return {-0.5, static_cast<double>(size), wrap == Wrap::mirrored_repeat};
}

std::vector<double> places(const std::vector<Line>& lines) {
  std::vector<double> result(lines.size());
  std::transform(lines.begin(), lines.end(), result.begin(), [](const Line& line) { return line.at; });
  return result;
}

}  // namespace

AlphaGrid alpha_of(const TextureImage& image, Filter filter) {
  AlphaGrid grid{image.width, image.height, {}, filter == Filter::nearest};
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  grid.alpha.resize(count);
  for (std::size_t i = 0; i < count; ++i) grid.alpha[i] = image.rgba[4 * i + 3];
  return grid;
}

AlphaGrid half_of(const AlphaGrid& grid) {
  AlphaGrid half{(grid.width + 1) / 2, (grid.height + 1) / 2, {}, grid.in_squares};
  half.alpha.reserve(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height));
  const auto at = [&](int x, int y) {
    x = std::min(x, grid.width - 1), y = std::min(y, grid.height - 1);
    return grid.alpha[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width) +
                      static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const float above = at(2 * x, 2 * y) + at(2 * x + 1, 2 * y);
      const float below = at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1);
      half.alpha.push_back(0.25f * (above + below));
    }
  }
  return half;
}

TiledSheet wrap_sheet(const AlphaGrid& grid, Wrap wrap_u, Wrap wrap_v) {
  const std::vector<Line> columns = lines_of(grid.width, wrap_u, grid.in_squares);
  const std::vector<Line> rows = lines_of(grid.height, wrap_v, grid.in_squares);
  TiledSheet result{{places(columns), places(rows), {}},
                    {tiling_of(grid.width, wrap_u), tiling_of(grid.height, wrap_v)}};
  result.sheet.values.reserve(columns.size() * rows.size());
  for (const Line& row : rows) {
    const auto above = static_cast<std::size_t>(row.first) * static_cast<std::size_t>(grid.width);
    const auto below = static_cast<std::size_t>(row.second) * static_cast<std::size_t>(grid.width);
    for (const Line& column : columns) {
      const auto left = static_cast<std::size_t>(column.first);
      const auto right = static_cast<std::size_t>(column.second);
      result.sheet.values.push_back(0.25f * ((grid.alpha[above + left] + grid.alpha[above + right]) +
                                             (grid.alpha[below + left] + grid.alpha[below + right])));
    }
  }
  return result;
}

AlphaSheet sample_sheet(std::vector<double> xs, std::vector<double> ys,
                        const std::function<double(double, double)>& value) {
  AlphaSheet sheet{std::move(xs), std::move(ys), {}};
  sheet.values.reserve(sheet.xs.size() * sheet.ys.size());
  for (const double y : sheet.ys)
    for (const double x : sheet.xs) sheet.values.push_back(static_cast<float>(value(x, y)));
  return sheet;
}

double sample_alpha(const AlphaGrid& grid, Wrap wrap_u, Wrap wrap_v, glm::dvec2 place) {
  if (grid.in_squares) place = glm::floor(place + 0.5);
  const double x0 = std::floor(place.x), y0 = std::floor(place.y);
  const auto column = static_cast<std::int64_t>(x0), row = static_cast<std::int64_t>(y0);
  const auto at = [&](std::int64_t x, std::int64_t y) -> double {
    const int i = texture::wrap(x, grid.width, wrap_u), j = texture::wrap(y, grid.height, wrap_v);
    return grid.alpha[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.width) +
                      static_cast<std::size_t>(i)];
  };
  const double u = place.x - x0, v = place.y - y0;
  const double above = at(column, row) * (1 - u) + at(column + 1, row) * u;
  const double below = at(column, row + 1) * (1 - u) + at(column + 1, row + 1) * u;
  return above * (1 - v) + below * v;
}

}  // namespace tenebra::stage
