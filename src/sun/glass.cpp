#include "sun/glass.h"

#include "points/point_tiles.h"
#include "points/sample_points.h"

namespace tenebra::sun {

Glass::Glass(const SeeThroughSurfaces& surfaces, const Geometry& geometry, const QueryPoints& points)
    : surfaces_(surfaces), geometry_(geometry) {
  const points::SampleGrid grid(points.positions.size());
  points_.width = grid.width(), points_.height = grid.height();
  points_.positions.resize(grid.pixels()), numbers_.resize(grid.pixels());
  points_.triangles.assign(grid.pixels(), no_triangle), points_.sides.assign(grid.pixels(), 1);
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const std::size_t pixel = grid.pixel(i);
    const std::uint32_t triangle = points.triangles.empty() ? no_triangle : points.triangles[i];
    points_.positions[pixel] = points.positions[i] - geometry.origin();
    points_.triangles[pixel] = triangle == no_triangle ? free_point : triangle;
    pixels_.push_back(pixel), numbers_[pixel] = i;
  }
  points::make_point_tiles(points_, geometry.view(), *points_.tiles);
}

bool Glass::dim(const ShadowLight& light, std::span<float> shares, const StopFlag* stop) {
  mask_.assign(points_.triangles.size(), 0);
  for (std::size_t i = 0; i < shares.size(); ++i) mask_[pixels_[i]] = shares[i] > 0 ? 255 : 0;
  if (!tracer_.trace(points_, geometry_.view(), surfaces_, light, mask_, config_, tints_, stop)) return false;
  config_.same_surfaces = true;
  constexpr glm::vec3 luminance(0.2126f, 0.7152f, 0.0722f);
  for (std::size_t k = 0; k < tints_.pixels.size(); ++k)
    shares[numbers_[tints_.pixels[k]]] *= glm::dot(luminance, tints_.factors[k]);
  return true;
}

}  // namespace tenebra::sun
