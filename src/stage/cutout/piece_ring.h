// The part of a triangle that lies in one leaf, as a ring of points: what bounds a piece besides the outline.
#pragma once

#include <vector>

#include "stage/cutout/piece.h"

namespace tenebra::stage {

/// What bounds a piece: sides 0 to 2 are the triangle's edges, 3 to 6 the leaf's x = low, x = high, y = low,
/// y = high.
inline constexpr int side_count = 7;
inline constexpr int leaf_side = 3;

/// The leaf, where its tile stands.
struct Rectangle {
  glm::dvec2 low, high;

  int axis(int side) const { return (side - leaf_side) / 2; }
  bool is_low(int side) const { return (side - leaf_side) % 2 == 0; }
  double line(int side) const { return (is_low(side) ? low : high)[axis(side)]; }
};
Rectangle place_leaf(const Leaf& leaf, const Tile& tile);

struct RingPoint {
  Spot spot;
  int side;  ///< that runs from here to the next
};
using Ring = std::vector<RingPoint>;

/// Triangle and rectangle, counter-clockwise: the triangle, cut at one side of the rectangle after the other.
Ring cut_ring(const PlaneTriangle& triangle, const Rectangle& leaf);

/// A ring with the corners of neighbouring leaves on this one's sides. `bounds`: of place_leaf.
Ring with_leaf_corners(const Ring& ring, const PlaneTriangle& triangle, const Rectangle& bounds,
                       const Leaf& leaf, const Tile& tile);

}  // namespace tenebra::stage
