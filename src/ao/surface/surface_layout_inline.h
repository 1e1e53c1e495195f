// The part of surface_layout.h that every point of a frame goes through, inlined where it is asked.
#pragma once

#include <algorithm>

#include "ao/surface/surface_layout.h"

namespace tenebra::ao {

inline std::size_t grid_size(std::uint32_t steps) {
  return (std::size_t{steps} + 1) * (std::size_t{steps} + 2) / 2;
}
/// Grid point (i, j), i + j <= steps, in rows of j.
inline std::uint32_t grid_index(std::uint32_t i, std::uint32_t j, std::uint32_t steps) {
  return j * (2 * steps + 3 - j) / 2 + i;
}

inline int levels_of(std::uint32_t steps) {
  return steps == 2 ? 2 : SurfaceLayout::most_levels;
}
/// Steps of a level along a side.
inline std::uint32_t level_steps(int level, std::uint32_t steps) {
  return steps >> (levels_of(steps) - 1 - level);
}
/// Where a level starts among a triangle's grids, each of which is whole.
inline std::uint32_t level_start(int level, std::uint32_t steps) {
  std::size_t start = 0;
  for (int wider = 0; wider < level; ++wider) start += grid_size(level_steps(wider, steps));
  return static_cast<std::uint32_t>(start);
}

/// Weights of a point that is in the triangle but for rounding.
struct Weights {
  float v, w;
  explicit Weights(const SurfacePoint& point)
      : v(std::clamp(point.v, 0.0f, 1.0f)), w(std::clamp(point.w, 0.0f, 1.0f - v)) {}
};

inline SurfaceLayout::Cell SurfaceLayout::cell(float v, float w, std::uint32_t count) {
  const auto steps = static_cast<float>(count);
  const auto i = std::min(static_cast<std::uint32_t>(v * steps), count - 1);
  const auto j = std::min(static_cast<std::uint32_t>(w * steps), count - 1 - i);
  const float fv = std::clamp(v * steps - static_cast<float>(i), 0.0f, 1.0f);
  const float fw = std::clamp(w * steps - static_cast<float>(j), 0.0f, 1.0f);
  const float sum = fv + fw;
  if (sum <= 1) return {{i, i + 1, i}, {j, j, j + 1}, {1 - sum, fv, fw}, false};
  if (i + j + 2 > count)  // beyond the long side by rounding
    return {{i, i + 1, i}, {j, j, j + 1}, {0, fv / sum, fw / sum}, false};
  return {{i + 1, i, i + 1}, {j + 1, j + 1, j}, {sum - 1, 1 - fv, 1 - fw}, true};
}

inline SampleTriple SurfaceLayout::around(const SurfacePoint& point, int level) const {
  const Weights at(point);
  const Grid grid = grids_[point.triangle];
  const std::uint32_t side = point.front ? 0 : 1, steps = level_steps(level, grid.steps);
  const std::uint32_t first = grid.first + level_start(level, grid.steps);
  const Cell c = cell(at.v, at.w, steps);
  const auto sample = [&](int k) { return 2 * (first + grid_index(c.i[k], c.j[k], steps)) + side; };
  return {{sample(0), sample(1), sample(2)}, {c.weights[0], c.weights[1], c.weights[2]}};
}

}  // namespace tenebra::ao
