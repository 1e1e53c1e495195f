// The part of a triangle that lies in a region, within one leaf of the region's outline.
#pragma once

#include <vector>

#include "stage/cutout/outline_tree.h"
#include "stage/cutout/plane_triangle.h"

namespace tenebra::stage {

/// Where a copy of the outline stands in the plane: its place p at offset + sign * p.
struct Tile {
  glm::dvec2 sign{1.0};
  glm::dvec2 offset{0.0};
};

enum class PieceKind {
  nothing,  ///< no part of the triangle
  whole,    ///< all of the triangle that lies in the leaf
  cut
};

/// Appends loops of spots, the region to their left. Loops of neighbouring leaves and tiles meet in the same
/// spots, as do those of triangles that share an edge.
PieceKind cut_piece(const PlaneTriangle& triangle, const Outline& outline, const Leaf& leaf, const Tile& tile,
                    std::vector<std::vector<Spot>>& loops);

}  // namespace tenebra::stage
