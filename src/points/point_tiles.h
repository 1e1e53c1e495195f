// The visible points once more, as hard shadows read them: tiles of 4x4 pixels in floats relative to a point
// nearby, boxes around them, and the triangles they lie on. They depend on no light: one form serves all
// lights. The points in double remain the ones that shadows are asked about; how far the floats are from them
// is known.
//
// Sixteen tiles make a square of 16x16 pixels, whose points share a base. A tile whose points lie on several
// triangles may straddle a gap in depth; this is noted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/visible_points.h>

namespace tenebra::points {

inline constexpr int tile_side = 4, tile_points = 16;
inline constexpr std::uint32_t square_side = 16;
inline constexpr std::uint32_t patch_squares = 64;           ///< in a row
inline constexpr std::uint16_t several_receivers = 0xffffu;  ///< no index of a receiver

/// What the points of a square are relative to.
struct PointBase {
  float at[3];   ///< exact
  float radius;  ///< >= |q| of all points of the square
  float grain;   ///< no q is off by more than 2^-24 of it; >= radius

  /// >= how far the points themselves are from the base.
  double reach() const { return double{radius} + 0x1p-23 * double{grain}; }
};

/// Sixteen pixels, four rows of four. The point of lane i is base + q_i, q as close as PointBase::grain says.
/// Lanes without a point, or on neither side of its triangle, hold the q of another.
struct alignas(64) PointTile {
  float qx[tile_points], qy[tile_points], qz[tile_points];
  std::uint32_t id[tile_points];  ///< where the square's receiver is several: of the triangle that the point
                                  ///< lies on, or no_triangle
};
static_assert(sizeof(PointTile) == 256);

/// Lanes of a tile whose points lie on the same triangle.
struct ReceiverLanes {
  std::uint16_t receiver, lanes;  ///< number in PointPatch::receivers; bits

  bool operator==(const ReceiverLanes&) const = default;
};

/// Sixteen tiles, boxes of q of each. Values of a tile that is not `filled` mean nothing.
struct alignas(64) PointSquare {
  float low[3][16], high[3][16];
  std::uint32_t own[16];       ///< triangle that all points lie on; no_triangle: several
  std::uint16_t receiver[16];  ///< the same as a number; several_receivers
  std::uint16_t lanes[16];     ///< that have a point
  std::uint32_t first_tile;
  std::uint32_t filled;  ///< bits of the tiles with points
  std::uint32_t gaps;    ///< bits of the tiles with a gap
  PointBase base;
  float tau;  ///< largest rounding tolerance of the points' triangles, rounded up
};

/// Sixteen triangles that points lie on, each from the side that its points are on: to there n points.
struct alignas(64) ReceiverBlock {
  float nx[16], ny[16], nz[16];  ///< unit normal to that side, rounded
  float ax[16], ay[16], az[16];  ///< a corner, exact
  float slack[16];  ///< n.(p - a) has the sign of the exact value where |n.(p - a)| > slack |p - a|
  float tau[16];    ///< rounding tolerance, rounded up
  std::uint32_t id[16];
  std::int8_t side[16];  ///< 1 or -1
};

/// Squares in a row, at most patch_squares.
struct PointPatch {
  std::vector<PointSquare> squares;  ///< that have points
  std::vector<ReceiverBlock> receivers;
  std::vector<ReceiverLanes> mixed;  ///< of tiles of several receivers, in the order of squares and tiles;
                                     ///< those of a tile divide its lanes among them
  std::uint32_t receiver_count = 0;
};

struct PointTiles {
  std::vector<PointTile>
      tiles;  ///< sixteen to a square, squares row by row; q of those without points as it was
  std::vector<PointBase> bases;  ///< one per square
  std::vector<PointPatch> patches;

  bool empty() const { return patches.empty(); }
};

struct SquareGrid {
  SquareGrid(int width, int height)
      : columns((static_cast<std::uint32_t>(width) + square_side - 1) / square_side),
        rows((static_cast<std::uint32_t>(height) + square_side - 1) / square_side),
        row_patches((columns + patch_squares - 1) / patch_squares) {}
  std::uint32_t columns, rows;
  std::uint32_t row_patches;
};

/// First pixels of tiles by their number.
class TilePixels {
public:
  TilePixels(int width, int height)
      : columns_(SquareGrid(width, height).columns), width_(static_cast<std::size_t>(width)) {}
  std::size_t operator()(std::uint32_t tile) const {
    const std::uint32_t square = tile / 16, row = square / columns_, column = square - row * columns_;
    return (static_cast<std::size_t>(row) * 16 + tile % 16 / 4 * 4) * width_ + column * 16 + tile % 4 * 4;
  }
  std::size_t operator()(std::uint32_t tile, int lane) const {
    return (*this)(tile) + static_cast<std::size_t>(lane / 4) * width_ + static_cast<std::size_t>(lane % 4);
  }

private:
  std::uint32_t columns_;
  std::size_t width_;
};

/// Makes room for the tiles of a picture; patches are then made one by one, in any order.
void begin_point_tiles(int width, int height, PointTiles& out);
/// Makes patch `patch` (row of squares * row_patches + part of the row) of points whose ids are known, from
/// their positions or, where these are missing, from their view. Both ways give the same but for q, which
/// positions give rounded and views a little less close, and what bounds q.
void make_point_patch(const VisiblePoints& points, const TriangleView& triangles, std::uint32_t patch,
                      PointTiles& out);
/// Makes the tiles of a whole picture.
void make_point_tiles(const VisiblePoints& points, const TriangleView& triangles, PointTiles& out);

}  // namespace tenebra::points
