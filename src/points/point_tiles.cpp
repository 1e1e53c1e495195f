#include "points/point_tiles.h"

#include <algorithm>

#include "parallel/parallel.h"
#include "points/patch_maker.h"

namespace tenebra::points {

void begin_point_tiles(int width, int height, PointTiles& out) {
  const SquareGrid grid(width, height);
  out.bases.resize(static_cast<std::size_t>(grid.columns) * grid.rows);
  out.tiles.resize(out.bases.size() * 16);
  out.patches.resize(static_cast<std::size_t>(grid.row_patches) * grid.rows);
}

void make_point_patch(const VisiblePoints& points, const TriangleView& triangles, std::uint32_t patch,
                      PointTiles& out) {
  const SquareGrid grid(points.width, points.height);
  PatchMaker maker(points, triangles, out, out.patches[patch]);
  const std::uint32_t row = patch / grid.row_patches, first = patch % grid.row_patches * patch_squares;
  const std::uint32_t y = row * square_side;
  for (std::uint32_t column = first; column < std::min(first + patch_squares, grid.columns); ++column) {
    maker.prefetch_corners((column + 1) * square_side, y);
    maker.add_square(column * square_side, y, (row * grid.columns + column) * 16);
  }
}

void make_point_tiles(const VisiblePoints& points, const TriangleView& triangles, PointTiles& out) {
  begin_point_tiles(points.width, points.height, out);
  parallel::parallel_tasks(static_cast<int>(out.patches.size()), [&](int patch) {
    make_point_patch(points, triangles, static_cast<std::uint32_t>(patch), out);
  });
}

}  // namespace tenebra::points
