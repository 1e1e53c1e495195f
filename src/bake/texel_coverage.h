// Which triangle each part of a lightmap's texels belongs to, by texture coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/sample.h"

namespace tenebra::bake {

/// A triangle as it lies in the map, in texels, (0,0) the map's top left corner.
struct MapTriangle {
  std::array<glm::dvec2, 3> corners{};
  std::uint32_t triangle = 0;  ///< id in FrameGeometry
  std::uint32_t part = 0;      ///< which mesh at its node
};

/// A texel that triangles touch only between its places: the largest piece of a triangle in it.
struct Sliver {
  std::uint32_t texel = 0;
  std::uint32_t owner = 0;  ///< index of the map triangle
  glm::dvec3 weights{0.0};  ///< of the piece's centroid
};

/// Each texel of a square map has per_side x per_side places, and each place the first triangle that it lies
/// in. Places stand a little off the grid, so that none lies on an edge or a wall by design of the scene.
class TexelCoverage {
public:
  static constexpr std::uint32_t none = 0xffffffffu;

  TexelCoverage(std::span<const MapTriangle> triangles, int size, int per_side);

  int size() const { return size_; }
  /// The samples of the texels of rows [first_row, first_row + band_rows), those of a texel after each other
  /// and neighbours close together.
  void samples_of_band(int first_row, std::vector<Sample>& out) const;
  static constexpr int band_rows = 64;

  std::size_t covered_places() const { return covered_; }
  /// Places that lie in two triangles, of one part and of two.
  std::size_t overlaps_within() const { return overlaps_within_; }
  std::size_t overlaps_between() const { return overlaps_between_; }

private:
  void cover_places(std::uint32_t index);
  void find_slivers();
  bool has_places(int x, int y) const;
  void add_texel(int x, int y, std::vector<Sample>& out) const;
  glm::dvec2 place(int column, int row) const;

  std::span<const MapTriangle> triangles_;
  int size_, per_side_;
  std::vector<std::uint32_t> owners_;  ///< of (size * per_side)^2 places, row by row; none: no triangle
  std::vector<Sliver> slivers_;        ///< ascending texels
  std::size_t covered_ = 0, overlaps_within_ = 0, overlaps_between_ = 0;
};

}  // namespace tenebra::bake
