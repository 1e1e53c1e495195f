// Makes the tiles of one patch from points or from their view.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "points/point_tile_kernels.h"
#include "points/point_tiles.h"
#include "points/receiver.h"
#include "points/sample_sides.h"
#include "points/seen_plane.h"
#include "points/smooth_surface.h"
#include "points/triangle_corners.h"

namespace tenebra::points {

inline constexpr std::uint16_t no_receiver = 0xfffeu;  ///< none, or one without area or on neither side

/// Makes one patch; takes some 36 KB of stack.
class PatchMaker {
public:
  PatchMaker(const VisiblePoints& points, const TriangleView& triangles, PointTiles& out, PointPatch& patch)
      : points_(points),
        from_view_(points.positions.empty()),
        view_(ViewOfSamples::or_any(points.seen_from)),
        rays_(view_),
        rows_(view_, points.width, points.height),
        triangles_(triangles),
        out_(out),
        patch_(patch),
        kernels_(point_tile_kernels(SimdLevel::automatic)),
        width_(static_cast<std::uint32_t>(points.width)),
        height_(static_cast<std::uint32_t>(points.height)) {
    patch_.squares.clear(), patch_.receivers.clear(), patch_.mixed.clear();
    if (from_view_) receivers_.reserve(256);
    patch_.receiver_count = 0;
  }

  /// Where the last square added many receivers, asks memory for the corners of those of the square with its
  /// first pixel at (x, y), of every other pixel of every other row: random reads, which take longer than the
  /// work that follows.
  void prefetch_corners(std::uint32_t x, std::uint32_t y);
  /// The square with its first pixel at (x, y), whose tiles are numbered from `first`.
  void add_square(std::uint32_t x, std::uint32_t y, std::uint32_t first);

private:
  struct Known {
    std::uint32_t id = no_triangle;
    std::int8_t side = 0;
    std::uint16_t number = 0;
  };
  /// What the points of a tile lie on.
  struct Seen {
    std::uint32_t lanes = 0;  ///< that have a point on one side of its triangle
    std::size_t count = 0;    ///< of parts
    ReceiverLanes parts[tile_points];
    std::uint32_t ids[tile_points];  ///< where there are several parts

    std::span<const ReceiverLanes> receivers() const { return {parts, count}; }
    void add(std::uint16_t number, std::uint32_t of) {
      if (number == no_receiver) return;
      parts[count++] = {number, static_cast<std::uint16_t>(of)};
      lanes |= of;
    }
  };

  std::uint16_t receiver_of(std::uint32_t id, int side = 0);
  std::uint16_t add_receiver(std::uint32_t id, int side);
  std::uint16_t add_free_receiver();
  int side_of(const Receiver& r, const Corners& c, double squares) const;
  bool is_point(std::uint32_t id) const { return id < triangles_.triangles.size() || id == free_point; }
  const std::uint32_t* ids_at(std::uint32_t x, std::uint32_t y) const {
    return &points_.triangles[static_cast<std::size_t>(y) * width_ + x];
  }
  bool one_receiver(std::uint32_t x, std::uint32_t y) const;
  void find_receivers(std::uint32_t x, std::uint32_t y, Seen& seen);
  void add_sides(std::uint32_t id, std::uint32_t lanes, std::uint32_t x, std::uint32_t y, Seen& seen);
  void see(const Seen& seen, glm::uvec2 at, TilePoints& points) const;
  bool lifts(const Seen& seen) const;
  const SeenPlane& plane_of(std::uint16_t receiver);
  bool see_in_float(const Seen& seen, glm::uvec2 at, const SquareEye& eye, PointTile& tile, int place,
                    PointSquare& square, PlaneError& error);
  void lift(const Seen& seen, TilePoints& points) const;
  void note_owners(const Seen& seen, int place, PointSquare& square) const;
  void note_free(const Seen& seen, const TilePoints& points, PointSquare& square) const;
  void note_ids(const Seen& seen, PointTile& tile) const;

  const VisiblePoints& points_;
  const bool from_view_;  ///< else from positions
  const ViewRays view_;   ///< tells sides, too, where they are not stored
  const PixelRays rays_;
  const RayRows rows_;
  const TriangleView& triangles_;
  PointTiles& out_;
  PointPatch& patch_;
  const PointTileKernels kernels_;
  const std::uint32_t width_, height_;
  std::uint32_t receivers_before_ = 0;        // when the last square began
  std::vector<Receiver> receivers_;           // by their numbers; from_view only
  std::vector<SmoothSurface> smooth_;         // likewise; with normals only
  std::vector<std::uint32_t> plane_numbers_;  // in planes_, of receivers, or no_plane yet; from_view only
  std::vector<SeenPlane> planes_;             // all zero, which no ray meets, of a flat receiver
  Known last_;
  std::array<Known, 4096> known_{};  // of the triangles that pixels nearby lie on
};

}  // namespace tenebra::points
