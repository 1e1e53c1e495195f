// Parts that both ways of grouping share.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "soft/groups/point_groups.h"
#include "soft/groups/point_lanes.h"

namespace tenebra::soft {

/// What all groups of a frame are made from.
struct Grouping {
  const VisiblePoints& points;
  const TriangleView& triangles;
  const LightShape light;
  const PointKernels kernels;
  PointGroups& out;
};

/// Groups of a part of the picture; their points go to out.pixels, where the caller says.
struct GroupPart {
  std::vector<PointGroup> groups;
  std::vector<Receiver> receivers;
  std::uint32_t next = 0;  ///< place of the next point in out.pixels
  PointLanes lanes;        ///< of the points at hand

  void begin(std::uint32_t place) {
    groups.clear(), receivers.clear();
    next = place;
  }
};

/// Pixels by triangle, each triangle's in row order: those of triangle k end at ends[k].
struct PixelsByTriangle {
  std::vector<std::uint32_t> pixels, ends;
  std::vector<std::uint8_t> active;     ///< room for a set of one triangle's
  std::vector<std::uint32_t> one_side;  ///< room for one triangle's, by sides
};

/// Adds the receivers of the free points among a group's: those with the least and the largest tolerance.
void append_free_receivers(const Grouping& grouping, const PointGroup& group, std::vector<Receiver>& out);

/// A set of 64 points, eight per byte.
inline std::array<std::uint8_t, 8> bytes_of(std::uint64_t set) {
  std::array<std::uint8_t, 8> bytes;
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(set >> (8 * i));
  return bytes;
}

/// One group for each square of 8x8 pixels, or more where its points do not lie together; each row of squares
/// is a part, of which there may be more from before.
std::span<GroupPart> group_tiles(const Grouping& grouping, std::vector<GroupPart>& parts);
/// One for each triangle.
void group_by_triangle(const Grouping& grouping, PixelsByTriangle& by, GroupPart& part);

}  // namespace tenebra::soft
