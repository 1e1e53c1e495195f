// Visible points in double from triangle ids: no depth value enters, so no bias is needed.
#include <tenebra/visible_points.h>

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"
#include "points/point_tiles.h"
#include "points/positions.h"
#include "points/visible_run.h"

namespace tenebra {

namespace {

using glm::dvec3;

points::Receiver receiver_of(const TriangleView& triangles, std::uint32_t id) {
  const glm::uvec3 t = triangles.triangles[id];
  points::Receiver r;
  r.id = id;
  r.a = triangles.positions[t.x];
  r.e1 = dvec3(triangles.positions[t.y]) - r.a;
  r.e2 = dvec3(triangles.positions[t.z]) - r.a;
  r.normal = glm::cross(r.e1, r.e2);
  const double area2 = glm::dot(r.normal, r.normal);
  r.flat = !(area2 > 0);
  if (!r.flat) {
    r.du = glm::cross(r.e2, r.normal) / area2;
    r.dv = glm::cross(r.normal, r.e1) / area2;
  }
  return r;
}

// Nearest admissible weights: negative ones to 0, renormalised. The point is then a double rounding off the
// plane, far inside the contact rule's tolerance.
dvec3 clamped(const points::Receiver& r, double u, double v) {
  const double w0 = std::max(0.0, 1 - u - v), w1 = std::max(0.0, u), w2 = std::max(0.0, v);
  const double sum = w0 + w1 + w2;
  return r.a + (w1 / sum) * r.e1 + (w2 / sum) * r.e2;
}

// Where origin + t direction meets the triangle's plane, in the triangle. A ray that misses the plane (the
// rasteriser saw a triangle edge-on) gets the centroid.
dvec3 visible_point(const points::Receiver& r, const dvec3& origin, const dvec3& direction) {
  const double speed = glm::dot(r.normal, direction);
  const double t = glm::dot(r.normal, r.a - origin) / speed;
  if (r.flat || !(t > 0) || !std::isfinite(t)) return r.a + (r.e1 + r.e2) / 3.0;
  const dvec3 p = origin + t * direction;
  const double u = glm::dot(r.du, p - r.a), v = glm::dot(r.dv, p - r.a);
  if (u >= 0 && v >= 0 && u + v <= 1) return p;
  if (!std::isfinite(u) || !std::isfinite(v)) return r.a + (r.e1 + r.e2) / 3.0;
  return clamped(r, u, v);
}

/// Pixels x ... end - 1 of a row, all of which see `r`.
void compute_run(const points::Receiver& r, const points::PixelRow& row, std::size_t x, std::size_t end,
                 const points::VisibleRunKernels& kernels, dvec3* out) {
  while (x < end) {
    const std::size_t count = std::min<std::size_t>(8, end - x);
    dvec3 points[8];
    const std::uint32_t inside = count > 2 && !r.flat ? kernels.eight(r, row, x, points) : 0;
    for (std::size_t i = 0; i < count; ++i, ++x) {
      const dvec3 across = (static_cast<double>(x) + 0.5) * row.dx + row.row;
      out[x] = ((inside >> i) & 1u) != 0 ? points[i] : visible_point(r, row.eye, row.d0 + across);
    }
  }
}

/// Rows first ... last - 1 of the picture: ids to `out`, positions to `rows`.
void compute_rows(std::span<const std::uint32_t> ids, std::size_t first, std::size_t last,
                  const ViewRays& view, const TriangleView& triangles, VisiblePoints& out, dvec3* rows) {
  const dvec3 eye(view.eye), d0(view.d0), dx(view.dx), dy(view.dy);
  const points::VisibleRunKernels kernels = points::visible_run_kernels(SimdLevel::automatic);
  const auto width = static_cast<std::size_t>(out.width);
  points::Receiver receiver;
  for (std::size_t y = first; y < last; ++y, rows += width) {
    const points::PixelRow row{eye, d0, dx, (static_cast<double>(y) + 0.5) * dy};
    for (std::size_t x = 0, end = 0; x < width; x = end) {
      const std::size_t pixel = y * width + x;
      while (end < width && ids[y * width + end] == ids[pixel]) ++end;
      const std::uint32_t id = ids[pixel] < triangles.triangles.size() ? ids[pixel] : no_triangle;
      std::fill_n(&out.triangles[pixel], end - x, id);
      if (id == no_triangle) continue;
      if (id != receiver.id) receiver = receiver_of(triangles, id);
      if (!view.orthographic) {
        compute_run(receiver, row, x, end, kernels, rows);
        continue;
      }
      for (std::size_t i = x; i < end; ++i)
        rows[i] = visible_point(receiver, eye + ((static_cast<double>(i) + 0.5) * dx + row.row), d0);
    }
  }
}

}  // namespace

void compute_visible_points(std::span<const std::uint32_t> ids, int width, int height, const ViewRays& view,
                            const TriangleView& triangles, VisiblePoints& out, PointLayout layout) {
  const parallel::FloatEnvironment ieee;  // denormal floats of the view become doubles here
  const bool kept = layout != PointLayout::tiles, tiled = layout != PointLayout::rows;
  out.width = width;
  out.height = height;
  out.view = view;
  out.positions.resize(kept ? ids.size() : 0);
  out.triangles.resize(ids.size());
  if (!tiled) out.tiles.clear();
  if (tiled) points::begin_point_tiles(width, height, view, *out.tiles);
  const points::SquareGrid grid(width, height);
  const auto columns = static_cast<std::size_t>(width), last = static_cast<std::size_t>(height);
  std::vector<std::vector<dvec3>> bands(kept ? 0 : static_cast<std::size_t>(thread_count()));
  // Tiles are made of rows that are still near.
  parallel::parallel_tasks(static_cast<int>(grid.rows), [&](int band) {
    const auto row = static_cast<std::uint32_t>(band);
    const std::size_t top = row * points::square_side;
    dvec3* rows = nullptr;
    if (kept) {
      rows = &out.positions[top * columns];
    } else {
      std::vector<dvec3>& own = bands[static_cast<std::size_t>(parallel::thread_index())];
      own.resize(points::square_side * columns);
      rows = own.data();
    }
    compute_rows(ids, top, std::min(top + points::square_side, last), view, triangles, out, rows);
    for (std::uint32_t part = 0; tiled && part < grid.row_patches; ++part)
      points::make_point_patch(out, rows, triangles, row * grid.row_patches + part, *out.tiles);
  });
}

dvec3 visible_position(const VisiblePoints& points, const TriangleView& triangles, std::size_t pixel) {
  if (!points.positions.empty()) return points.positions[pixel];
  const auto width = static_cast<std::size_t>(points.width);
  const ViewRays& view = points.view;
  const dvec3 eye(view.eye), d0(view.d0), dx(view.dx), dy(view.dy);
  const double x = static_cast<double>(pixel % width) + 0.5, y = static_cast<double>(pixel / width) + 0.5;
  const dvec3 across = x * dx + y * dy;
  const points::Receiver receiver = receiver_of(triangles, points.triangles[pixel]);
  return view.orthographic ? visible_point(receiver, eye + across, d0)
                           : visible_point(receiver, eye, d0 + across);
}

namespace points {

const VisiblePoints& with_positions(const VisiblePoints& points, const TriangleView& triangles,
                                    VisiblePoints& scratch) {
  if (!points.positions.empty() || points.triangles.empty()) return points;
  compute_visible_points(points.triangles, points.width, points.height, points.view, triangles, scratch);
  return scratch;
}

}  // namespace points

}  // namespace tenebra
