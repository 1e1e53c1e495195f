// Visible points of samples anywhere within pixels. They are placed in a picture of their own, so that any
// code for visible points works on them too.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include <tenebra/visible_points.h>

namespace tenebra::points {

/// The picture in which the `count` samples of a list are placed: sixteen that follow each other make a tile
/// of PointTiles, 256 a square. Samples that belong together should follow each other.
class SampleGrid {
public:
  explicit SampleGrid(std::size_t count)
      : height_(16 *
                static_cast<int>(std::max<std::size_t>(1, (count + 256 * columns - 1) / (256 * columns)))) {}
  int width() const { return static_cast<int>(16 * columns); }
  int height() const { return height_; }
  /// The number of pixels of the whole picture, places without a sample included.
  std::size_t pixels() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height_); }
  /// Where sample `i` stands.
  std::size_t pixel(std::size_t i) const {
    const std::size_t square = i / 256, tile = i % 256 / 16, lane = i % 16;
    const std::size_t x = square % columns * 16 + tile % 4 * 4 + lane % 4,
                      y = square / columns * 16 + tile / 4 * 4 + lane / 4;
    return y * 16 * columns + x;
  }

private:
  static constexpr std::size_t columns = 64;  // squares in a row, which are a patch
  int height_;
};

/// Finds the points of samples that see triangle ids[p] at places[p], in pixels of `view` with (0.5, 0.5) the
/// centre of the top left one: as compute_visible_points does, which gives the same bits where a place is the
/// centre of a pixel. `ids`, `places`: of SampleGrid(count) by its pixels; ids out of range count as
/// no_triangle. `out` gets rows of positions, and no tiles.
void compute_sample_points(std::span<const std::uint32_t> ids, std::span<const glm::vec2> places,
                           std::size_t count, const ViewRays& view, const TriangleView& triangles,
                           VisiblePoints& out);

/// The points of `pixels` of `from`, which has positions: a list again, at SampleGrid(pixels.size()).
void take_points(const VisiblePoints& from, std::span<const std::uint32_t> pixels, VisiblePoints& out);

}  // namespace tenebra::points
