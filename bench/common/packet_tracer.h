// A thread's packets of 4, 8 or 16 rays through one of Embree's trees, tile after tile.
#pragma once

#include <array>
#include <string>

#include "bench/common/embree_tree.h"
#include "bench/common/ray_tile.h"

namespace tenebra::bench {

/// How a tile's rays are handed to Embree.
struct PacketPlan {
  int size = 4;  ///< rays in a packet: 4, 8 or 16
  TileShape shape = TileShape::square;
  RayWay way = RayWay::to_light;  ///< of shadow rays
};
/// All that are worth trying with a tree: packets of 16 as 4x4 and 8x2, of 8 as 4x2, of 4 as 2x2, both ways
/// each; those that its device takes.
std::vector<PacketPlan> packet_plans(const EmbreeTree& tree);
std::string packet_plan_name(const PacketPlan& plan);  ///< "4x4 from" the light

class PacketTracer {
public:
  /// Refers to both. `simd`: instructions of what is beside Embree.
  PacketTracer(const EmbreeTree& tree, const PacketPlan& plan, SimdLevel simd);

  /// What the rays from the eye through the tile at pixel (x, y) meet; no_triangle: nothing.
  void look(const ViewRays& view, float x, float y, std::uint32_t ids[16], TilePlanes& planes,
            TilePoints& points);
  /// Where the rays through the tile at pixel (x, y) meet planes that are known.
  void place(const ViewRays& view, float x, float y, const TilePlanes& planes, TilePoints& points) const {
    kernels_.place(planes, view, lanes_, x, y, points);
  }
  /// Bits of the lanes that see the light.
  std::uint32_t lit(const TilePlanes& planes, const TilePoints& points, const LightAim& light);

private:
  template <class Chosen>
  void look_all(Chosen& packet, const ViewRays& view, float x, float y, std::uint32_t ids[16],
                TilePlanes& planes, TilePoints& points);
  template <class Chosen>
  std::uint32_t lit_all(Chosen& packet, const TilePlanes& planes, const TilePoints& points,
                        const LightAim& light);

  // Rays of one size, with the fields that do not change filled in.
  template <int N, class Hits, class Rays>
  struct Packet {
    static constexpr int size = N;
    alignas(64) Hits hits{};
    alignas(64) Rays rays{};
    alignas(64) std::int32_t valid[16];
    alignas(64) std::int32_t all[16];
    Packet();
  };

  const EmbreeTree& tree_;
  const PacketPlan plan_;
  const TileLanes lanes_;
  const RayTileKernels kernels_;
  ao::EmbreeQuery query_{ao::EmbreeQuery::coherent};
  Packet<16, RTCRayHit16, RTCRay16> sixteen_;
  Packet<8, RTCRayHit8, RTCRay8> eight_;
  Packet<4, RTCRayHit4, RTCRay4> four_;
};

/// The tiles of a picture in squares of 16x16 pixels, and how a tile's lanes lie in planes of pixels.
class TileGrid {
public:
  static constexpr int square = 16;
  TileGrid(int width, int height, TileShape shape)
      : width_(width), height_(height), columns_(shape == TileShape::square ? 4 : 8), rows_(16 / columns_) {}

  int square_rows() const { return (height_ + square - 1) / square; }
  int square_columns() const { return (width_ + square - 1) / square; }
  /// First pixel of tile `tile` (0 ... 15) of a square.
  glm::ivec2 first(glm::ivec2 square_at, int tile) const {
    const int in_a_row = square / columns_;
    return {square_at.x * square + tile % in_a_row * columns_,
            square_at.y * square + tile / in_a_row * rows_};
  }
  /// Ids of the tile at `at`; no_triangle beyond the picture.
  void take(const std::uint32_t* plane, glm::ivec2 at, std::uint32_t ids[16]) const;
  void put(const std::uint32_t ids[16], glm::ivec2 at, std::uint32_t* plane) const;
  /// 255 where the lane's bit is set, else 0.
  void put_bits(std::uint32_t bits, glm::ivec2 at, std::uint8_t* plane) const;

private:
  bool inside(glm::ivec2 at) const { return at.x + columns_ <= width_ && at.y + rows_ <= height_; }
  glm::ivec2 lane(int i) const {
    const int blocks = columns_ / 2;
    return {i / 4 % blocks * 2 + i % 2, i / 4 / blocks * 2 + i / 2 % 2};
  }
  std::size_t place(glm::ivec2 at) const {
    return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(at.x);
  }
  /// Calls body(first lane of two, their place in the plane) for a tile that is inside.
  template <class Body>
  void for_pairs(glm::ivec2 at, const Body& body) const {
    for (int pair = 0; pair < 8; ++pair) body(2 * pair, place(at + lane(2 * pair)));
  }

  int width_, height_;
  int columns_, rows_;  // of a tile
};

}  // namespace tenebra::bench
