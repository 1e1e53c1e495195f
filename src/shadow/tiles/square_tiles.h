// From visible points to ray tiles: one square of 16x16 pixels after another.
#pragma once

#include <cstdint>
#include <vector>

#include "shadow/ray_kernels.h"
#include "shadow/tiles/ray_forest.h"
#include "shadow/tiles/tile_kernels.h"

namespace tenebra {

inline constexpr std::uint32_t square_side = 16;

struct SquareGrid {
  SquareGrid(int width, int height)
      : columns((static_cast<std::uint32_t>(width) + square_side - 1) / square_side),
        rows((static_cast<std::uint32_t>(height) + square_side - 1) / square_side) {}
  std::uint32_t columns, rows;
};

/// Makes the tiles of a row of squares, and tells which squares are nodes as they stand. One for all threads.
class SquareSorter {
public:
  SquareSorter(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
               const ShadowLight& light, const RaySource& source, const HardShadowConfig& config);

  /// Tiles of row `row` at their sixteen places a square in `tiles`; further ones, nodes, loose tiles and
  /// keys in `out`. Tiles in `out` are numbered on from tiles.size().
  void sort_row(std::uint32_t row, std::vector<RayTile>& tiles, ForestScratch::Row& out) const;

private:
  struct Receivers;
  struct Square;
  struct Keys;

  struct Lanes;

  bool faces(std::uint32_t id, Receivers& receivers, float& tau) const;
  Lanes active_lanes(std::uint32_t x, std::uint32_t y, Receivers& receivers) const;
  std::uint32_t same_triangle(std::uint32_t x, std::uint32_t y) const;
  std::uint32_t in_reach_lanes(std::uint32_t x, std::uint32_t y, std::uint32_t lanes) const;
  std::uint32_t off_the_light(std::uint32_t x, std::uint32_t y, std::uint32_t lanes,
                              ForestScratch::Row& out) const;
  std::size_t pixel_at(std::uint32_t x, std::uint32_t y, int lane) const;
  void read_square(std::uint32_t x, std::uint32_t y, RayTile* tiles, Receivers& receivers, Square& square,
                   ForestScratch::Row& out) const;
  void fetch_square(std::uint32_t x, std::uint32_t y) const;
  bool make_node(const RayTile* tiles, std::uint32_t first_tile, Square& square, Keys& keys, ForestScratch::Row& out) const;
  void loosen_tile(std::uint32_t x, std::uint32_t y, std::uint32_t number, std::vector<RayTile>& tiles,
                   Keys& keys, ForestScratch::Row& out) const;

  const VisiblePoints& points_;
  const ViewRays& view_;
  const TriangleView& triangles_;
  const ShadowLight& light_;
  const RaySource& source_;
  bool use_tau_;
  bool bounded_;  ///< by a cone or a range
  TileKernels kernels_;
  RayKernels ray_kernels_;
};

}  // namespace tenebra
