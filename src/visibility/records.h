// Data passed between the stages of a drawing: vertices in the window, triangles set up, triangles in a tile.
// Internal to visibility.
#pragma once

#include <cstdint>
#include <vector>

namespace tenebra::visibility {

constexpr int tile_side = 64;    // pixels
constexpr int block_side = 4;    // pixels: the sixteen of a vector
constexpr int region_side = 16;  // pixels: sixteen blocks
constexpr int tile_pixels = tile_side * tile_side;
constexpr int tile_blocks = tile_pixels / 16;

/// Depth of a vertex without a place in the window: surely before the near plane, or anywhere.
constexpr float before_near = 1e30f, anywhere = -1.0f;
constexpr float largest_depth = 1e29f;  ///< of a vertex with a place

/// Places of vertices, by coordinate.
struct WindowVertices {
  std::vector<float> x, y;   ///< pixels
  std::vector<float> depth;  ///< above 1: before the near plane
};

/// Triangles that may cover a pixel's centre, with the pixels around them.
struct Candidates {
  std::vector<std::uint32_t> ids;
  std::vector<std::int32_t> x0, y0, x1, y1;  ///< first and last pixel
  std::vector<float> near_depth, far_depth;  ///< of any point of it that is seen; near_depth >= far_depth
  void resize(std::size_t count) {
    for (auto* list : {&x0, &y0, &x1, &y1}) list->resize(count);
    for (auto* list : {&near_depth, &far_depth}) list->resize(count);
    ids.resize(count);
  }
};

/// Eight triangles as functions of the window's place (X, Y): value = at_origin + X along_x + Y along_y.
/// 0..2: the edge against vertex 0..2, above 0 inside, steepest coordinate slope 1 per pixel; 3: depth.
struct TriangleSetup8 {
  double at_origin[4][8];
  double along_x[4][8];
  double along_y[4][8];
  /// The edges in float and bounded, as TileRecord has them, from the first pixel of the triangle's box on.
  float value_at_box[4][8];
  float step_x[4][8];
  float step_y[4][8];
  /// Bit k: the rounding that `Window::reach` bounds may be more than 2^-15 pixels for an edge of triangle k;
  /// and: which side the triangle shows is not certain.
  std::uint32_t doubtful = 0;
  std::uint32_t side_unknown = 0;
  std::uint32_t back = 0;  ///< bit k: set up as showing its back (facing < 0)
};

/// Within 2^-13 pixels of an edge, ExactCoverage decides on which side a place is. Derived in lanes-inl.h.
constexpr float edge_band = 0x1p-13f;
constexpr double most_doubt = 0x1p-15;
/// What a record's numbers are bounded by, where the sign alone counts: of edges pixels, of depths.
constexpr double farthest_edge = 1000.0, steepest_depth = 1e30;

/// A triangle in a tile. Functions as those of TriangleSetup8, in float, of the offset from the centre of
/// pixel (x0, y0).
struct TileRecord {
  float value[4];
  float along_x[4];
  float along_y[4];
  float near_depth, far_depth;
  std::uint32_t id;             ///< bit 31: every pixel is doubtful
  std::uint8_t x0, y0, x1, y1;  ///< first and last pixel of the tile that it may cover
};
static_assert(sizeof(TileRecord) == 64);
constexpr std::uint32_t doubtful_bit = 0x80000000u;

/// Sixteen pixels of a block lie together, row after row; sixteen blocks of a region too, then the regions.
struct alignas(64) Tile {
  float depth[tile_pixels];       ///< 0: nothing seen
  std::int32_t ids[tile_pixels];  ///< -1: nothing seen
  float far_depth[tile_blocks];   ///< least depth of a block
};

/// Index of a block in far_depth; times sixteen, of its first pixel.
constexpr int block_index(int block_x, int block_y) {
  return ((block_y >> 2) * 4 + (block_x >> 2)) * 16 + (block_y & 3) * 4 + (block_x & 3);
}

}  // namespace tenebra::visibility
