// Visible points in double from triangle ids: no depth value enters, so no bias is needed.
#include <tenebra/visible_points.h>

#include <algorithm>
#include <cassert>

#include "parallel/parallel.h"
#include "points/point_tile_kernels.h"
#include "points/point_tiles.h"
#include "points/positions.h"
#include "points/receiver.h"
#include "points/smooth_surface.h"
#include "points/visible_run.h"

namespace tenebra {

namespace {

using glm::dvec3;

/// Pixels x ... end - 1 of a row, all of which see `r`.
void compute_run(const points::Receiver& r, const points::PixelRow& row, std::size_t x, std::size_t end,
                 const points::VisibleRunKernels& kernels, dvec3* out) {
  while (x < end) {
    const std::size_t count = std::min<std::size_t>(8, end - x);
    dvec3 points[8];
    const std::uint32_t inside = count > 2 && !r.flat ? kernels.eight(r, row, x, points) : 0;
    for (std::size_t i = 0; i < count; ++i, ++x) {
      const dvec3 across = (static_cast<double>(x) + 0.5) * row.dx + row.row;
      out[x] = ((inside >> i) & 1u) != 0 ? points[i] : points::visible_point(r, row.eye, row.d0 + across);
    }
  }
}

/// Smooth surfaces of the triangles that rows nearby see.
class SmoothCache {
public:
  /// That of a sample on triangle `id`.
  const points::SmoothSurface& find(const TriangleView& triangles, std::uint32_t id,
                                    points::SideFinder& sides, std::size_t sample) {
    Known& known = known_[id % known_.size()];
    if (known.id == id && (!sides.differ() || known.side == sides.at(sample))) return known.surface;
    const int side = sides.at(sample);
    known = {id, side, points::smooth_surface(triangles, id, side)};
    return known.surface;
  }

private:
  struct Known {
    std::uint32_t id = no_triangle;
    int side = 0;
    points::SmoothSurface surface;
  };
  std::vector<Known> known_{512};
};

/// Lifts points first ... last - 1.
void lift_points(std::size_t first, std::size_t last, const TriangleView& triangles, SmoothCache& smooth,
                 VisiblePoints& points) {
  points::SideFinder sides(points, triangles);
  for (std::size_t i = first; i < last; ++i) {
    const std::uint32_t id = points.triangles[i];
    if (id >= triangles.triangles.size()) continue;
    const points::SmoothSurface& surface = smooth.find(triangles, id, sides, i);
    if (surface.lifts) points.positions[i] = points::lifted(surface, points.positions[i]);
  }
}

/// Rows first ... last - 1 of the picture.
void compute_rows(std::span<const std::uint32_t> ids, std::size_t first, std::size_t last,
                  const ViewRays& view, const TriangleView& triangles, VisiblePoints& out) {
  const dvec3 eye(view.eye), d0(view.d0), dx(view.dx), dy(view.dy);
  const points::VisibleRunKernels kernels = points::visible_run_kernels(SimdLevel::automatic);
  const auto width = static_cast<std::size_t>(out.width);
  points::Receiver receiver;
  SmoothCache smooth;
  for (std::size_t y = first; y < last; ++y) {
    dvec3* const rows = &out.positions[y * width];
    const points::PixelRow row{eye, d0, dx, (static_cast<double>(y) + 0.5) * dy};
    for (std::size_t x = 0, end = 0; x < width; x = end) {
      const std::size_t pixel = y * width + x;
      while (end < width && ids[y * width + end] == ids[pixel]) ++end;
      const std::uint32_t id = ids[pixel] < triangles.triangles.size() ? ids[pixel] : no_triangle;
      std::fill_n(&out.triangles[pixel], end - x, id);
      if (id == no_triangle) continue;
      if (id != receiver.id) receiver = points::receiver_of(triangles, id);
      if (!view.orthographic) {
        compute_run(receiver, row, x, end, kernels, rows);
        continue;
      }
      for (std::size_t i = x; i < end; ++i)
        rows[i] = points::visible_point(receiver, eye + ((static_cast<double>(i) + 0.5) * dx + row.row), d0);
    }
    if (!triangles.normals.empty()) lift_points(y * width, (y + 1) * width, triangles, smooth, out);
  }
}

/// Pixels first ... last - 1; ids out of range become no_triangle.
void copy_ids(std::span<const std::uint32_t> ids, std::size_t first, std::size_t last, std::size_t count,
              VisiblePoints& out) {
  static const points::PointTileKernels kernels = points::point_tile_kernels(SimdLevel::automatic);
  kernels.copy_ids(ids.subspan(first, last - first), count, &out.triangles[first]);
}

}  // namespace

void compute_visible_points(std::span<const std::uint32_t> ids, int width, int height, const ViewRays& view,
                            const TriangleView& triangles, VisiblePoints& out, PointLayout layout) {
  const parallel::FloatEnvironment ieee;  // denormal floats of the view become doubles here
  const bool kept = layout != PointLayout::tiles, tiled = layout != PointLayout::rows;
  out.width = width;
  out.height = height;
  out.seen_from = view;
  out.sides.clear();
  out.positions.resize(kept ? ids.size() : 0);
  out.triangles.resize(ids.size());
  if (!tiled) out.tiles.clear();
  if (tiled) points::begin_point_tiles(width, height, *out.tiles);
  const points::SquareGrid grid(width, height);
  const auto columns = static_cast<std::size_t>(width);
  // Tiles are made while ids and positions are still in the cache.
  parallel::parallel_tasks(static_cast<int>(grid.rows), [&](int band) {
    const auto row = static_cast<std::uint32_t>(band);
    const std::size_t top = row * points::square_side,
                      end =
                          std::min<std::size_t>(top + points::square_side, static_cast<std::size_t>(height));
    if (kept) {
      compute_rows(ids, top, end, view, triangles, out);
    } else {
      copy_ids(ids, top * columns, end * columns, triangles.triangles.size(), out);
    }
    for (std::uint32_t part = 0; tiled && part < grid.row_patches; ++part)
      points::make_point_patch(out, triangles, row * grid.row_patches + part, *out.tiles);
  });
}

dvec3 visible_position(const VisiblePoints& points, const TriangleView& triangles, std::size_t pixel) {
  if (!points.positions.empty()) return points.positions[pixel];
  return points::PositionFinder(points, triangles).at(pixel);
}

void lift_visible_points(const TriangleView& triangles, VisiblePoints& points) {
  const parallel::FloatEnvironment ieee;
  if (triangles.normals.empty()) return;
  parallel::parallel_ranges(points.positions.size(), 4096, [&](std::size_t first, std::size_t last) {
    SmoothCache smooth;
    lift_points(first, last, triangles, smooth, points);
  });
  if (!points.tiles.empty()) points::make_point_tiles(points, triangles, *points.tiles);
}

namespace points {

dvec3 PositionFinder::at(std::size_t pixel) {
  if (!points_.positions.empty()) return points_.positions[pixel];
  const auto width = static_cast<std::size_t>(points_.width);
  const std::uint32_t id = points_.triangles[pixel];
  if (id != receiver_.id) {
    receiver_ = receiver_of(triangles_, id);
    if (!triangles_.normals.empty()) smooth_ = smooth_surface(triangles_, id, sides_.at(pixel));
  }
  const dvec3 p = rays_.point_on(receiver_, pixel % width, pixel / width);
  return smooth_.lifts ? lifted(smooth_, p) : p;
}

const VisiblePoints& with_positions(const VisiblePoints& points, const TriangleView& triangles,
                                    VisiblePoints& scratch) {
  if (!points.positions.empty() || points.triangles.empty()) return points;
  assert(ViewOfSamples::of(points.seen_from) != nullptr);
  compute_visible_points(points.triangles, points.width, points.height,
                         ViewOfSamples::or_any(points.seen_from), triangles, scratch);
  scratch.sides = points.sides;
  return scratch;
}

}  // namespace points

}  // namespace tenebra
