// What is done to the sixteen points of a tile before any triangle is met.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shadow/tiles/ray_forest.h"

namespace tenebra {

/// Points of a tile relative to the light, rounded to float; lanes without a ray repeat the first that has
/// one.
struct TilePoints {
  alignas(64) float x[tile_rays], y[tile_rays], z[tile_rays];
  float nearest, farthest;  ///< least and greatest of the largest |coordinate| of a point
};

/// Where the four rows of a tile's points stand: in the picture, or, where that ends, in a copy.
class TileRows {
public:
  TileRows(const VisiblePoints& points, std::uint32_t x, std::uint32_t y) {
    const auto width = static_cast<std::uint32_t>(points.width),
               height = static_cast<std::uint32_t>(points.height);
    const std::size_t first = static_cast<std::size_t>(y) * width + x;
    const bool inside = x + tile_side <= width && y + tile_side <= height;
    for (std::uint32_t row = 0; row < tile_side; ++row) {
      const glm::dvec3* const from = points.positions.data() + first + static_cast<std::size_t>(row) * width;
      rows_[row] = inside ? from : copies_[row];
      for (std::uint32_t column = 0; !inside && column < tile_side; ++column)
        copies_[row][column] = x + column < width && y + row < height ? from[column] : glm::dvec3(0.0);
    }
  }
  TileRows(const TileRows&) = delete;
  TileRows& operator=(const TileRows&) = delete;

  const glm::dvec3* operator[](int row) const { return rows_[row]; }
  const glm::dvec3& point(int lane) const { return rows_[(lane / 4) & 3][lane % 4]; }

private:
  const glm::dvec3* rows_[4];
  glm::dvec3 copies_[4][4];
};

/// Code for one instruction set.
struct TileKernels {
  /// Points of the lanes in `lanes` (not 0).
  void (*project)(const TileRows& rows, const glm::dvec3& origin, std::uint32_t lanes,
                  TilePoints& points) = nullptr;
  /// Lanes of `lanes` beyond a gap: farther from the first of them than the others by half of the extent.
  std::uint32_t (*beyond_gap)(const TilePoints& points, std::uint32_t lanes) = nullptr;
  /// Box on a face, widened; false if a point is off the face (z <= 0 or beyond face_limit).
  bool (*bound)(const TilePoints& points, int face, FaceBox& box) = nullptr;
};
TileKernels tile_kernels(SimdLevel level);

}  // namespace tenebra
