#include "points/sample_points.h"

#include "parallel/parallel.h"
#include "points/receiver.h"

namespace tenebra::points {

using glm::dvec3;

void compute_sample_points(std::span<const std::uint32_t> ids, std::span<const glm::vec2> places,
                           std::size_t count, const ViewRays& view, const TriangleView& triangles,
                           VisiblePoints& out) {
  const parallel::FloatEnvironment ieee;
  const SampleGrid grid(count);
  out.width = grid.width();
  out.height = grid.height();
  out.seen_from = view;
  out.sides.clear();
  out.tiles.clear();
  out.triangles.assign(grid.pixels(), no_triangle);
  out.positions.resize(grid.pixels());
  const dvec3 eye(view.eye), d0(view.d0), dx(view.dx), dy(view.dy);
  parallel::parallel_ranges(count, 4096, [&](std::size_t first, std::size_t last) {
    Receiver receiver;
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t pixel = grid.pixel(i);
      const std::uint32_t id = ids[pixel];
      if (id >= triangles.triangles.size()) continue;
      if (id != receiver.id) receiver = receiver_of(triangles, id);
      const glm::dvec2 place(places[pixel]);
      const dvec3 across = place.x * dx + place.y * dy;
      out.triangles[pixel] = id;
      out.positions[pixel] = view.orthographic ? visible_point(receiver, eye + across, d0)
                                               : visible_point(receiver, eye, d0 + across);
    }
  });
}

void take_points(const VisiblePoints& from, std::span<const std::uint32_t> pixels, VisiblePoints& out) {
  const SampleGrid grid(pixels.size());
  out.width = grid.width();
  out.height = grid.height();
  out.seen_from = from.seen_from;
  out.sides.clear();
  out.tiles.clear();
  out.triangles.assign(grid.pixels(), no_triangle);
  out.positions.resize(grid.pixels());
  if (!from.sides.empty()) out.sides.resize(grid.pixels());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    out.triangles[grid.pixel(i)] = from.triangles[pixels[i]];
    out.positions[grid.pixel(i)] = from.positions[pixels[i]];
    if (!from.sides.empty()) out.sides[grid.pixel(i)] = from.sides[pixels[i]];
  }
}

}  // namespace tenebra::points
