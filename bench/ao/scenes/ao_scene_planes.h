// Pixels coordinate by coordinate, as the opponent's filter reads them, and values beside them.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/ao/scenes/ao_scene_kernels.h"
#include "bench/common/bench_frame.h"

namespace tenebra::bench {

/// One of step x step pixels of a picture, the first at `first`.
struct PixelGrid {
  int width = 0, height = 0;
  int step = 1;
  glm::ivec2 first{0};
  static PixelGrid of(const VisiblePoints& points, int step, glm::ivec2 first) {
    return {(points.width - first.x + step - 1) / step, (points.height - first.y + step - 1) / step, step,
            first};
  }
  std::size_t pixel(int x, int y, int picture_width) const {
    return static_cast<std::size_t>(y * step + first.y) * static_cast<std::size_t>(picture_width) +
           static_cast<std::size_t>(x * step + first.x);
  }
};

/// Where pixels stand in planes: with a border for the filter's reach and for whole vectors.
class PlaneLayout {
public:
  static constexpr int columns = 16, rows = 8;  ///< of the border, each side
  PlaneLayout() = default;
  PlaneLayout(int width, int height)
      : pitch_(2 * columns + (width + 15) / 16 * 16), size_(pitch_ * (height + 2 * rows)) {}
  std::ptrdiff_t at(int x, int y) const { return (y + rows) * pitch_ + x + columns; }
  std::ptrdiff_t pitch() const { return pitch_; }
  std::size_t size() const { return static_cast<std::size_t>(size_); }

private:
  std::ptrdiff_t pitch_ = 0, size_ = 0;
};

/// Positions and normals of a grid's pixels; zero where nothing is seen: like no other.
class PixelPlanes {
public:
  PixelPlanes(const BenchFrame& frame, const PixelGrid& grid);
  /// From the frame anew, on all threads.
  void take();
  const PlaneLayout& layout() const { return layout_; }
  AoPixelPlanes view() const { return {plane(0), plane(1), plane(2), plane(3), plane(4), plane(5)}; }

private:
  const float* plane(std::size_t k) const { return &values_[k * layout_.size()]; }
  const BenchFrame& frame_;
  PixelGrid grid_;
  PlaneLayout layout_;
  std::vector<float> values_;
};

}  // namespace tenebra::bench
