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
  const ViewRays& view;
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
};

/// A set of 64 points, eight per byte.
inline std::array<std::uint8_t, 8> bytes_of(std::uint64_t set) {
  std::array<std::uint8_t, 8> bytes;
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(set >> (8 * i));
  return bytes;
}

/// One group for each square of 8x8 pixels, or more where its points do not lie together; each row of squares
/// is a part.
std::vector<GroupPart> group_tiles(const Grouping& grouping);
/// One for each triangle.
GroupPart group_by_triangle(const Grouping& grouping);

}  // namespace tenebra::soft
