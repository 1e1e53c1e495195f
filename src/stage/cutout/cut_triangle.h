// One triangle, replaced by the part of it that a region leaves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stage/cutout/outline_tree.h"

namespace tenebra::stage {

/// A region of the plane: one outline, and how its copies fill the plane.
struct Region {
  OutlineTree tree;
  std::array<AxisTiling, 2> tiling;
};

/// A vertex of the cut triangle, between corners of the whole one. Of a vertex on an edge, the two corners
/// stand in an order that depends on their places only, so that both triangles of the edge agree to the bit.
struct CutVertex {
  int corners = 1;  ///< how many of `corner` count
  std::array<int, 3> corner{0, 0, 0};
  glm::dvec3 weight{1, 0, 0};
};

struct CutTriangle {
  bool whole = false;  ///< as it was; the lists are empty
  std::vector<CutVertex> vertices;
  std::vector<glm::uvec3> triangles;  ///< they face where the whole one does
};

/// A triangle over more copies of the outline than this is not cut.
constexpr double most_tiles = 16384;

/// `corners`: finite, and not on one line. False if it covers too many tiles, or more than `most_triangles`
/// are needed or, by its area, to be expected.
bool cut_triangle(const std::array<glm::dvec2, 3>& corners, const Region& region, std::size_t most_triangles,
                  CutTriangle& out);

}  // namespace tenebra::stage
