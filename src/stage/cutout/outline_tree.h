// An outline in rectangles with few segments each, so that a triangle looks only at what is near it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stage/cutout/outline.h"

namespace tenebra::stage {

/// A rectangle of the plane: low <= place < high.
struct Leaf {
  glm::dvec2 low{0.0}, high{0.0};
  std::vector<std::uint32_t> segments;  ///< those that may meet it, by their first point, ascending
  bool corner_inside = false;           ///< whether `low` lies in the region
  /// Corners of other leaves on its sides x = low.x, x = high.x, y = low.y, y = high.y, by the coordinate
  /// along the side, ascending.
  std::array<std::vector<double>, 4> corners_on_side;
};

struct OutlineTree {
  Outline outline;
  std::vector<Leaf> leaves;  ///< they fill a rectangle that holds the whole outline, with room around it
};

OutlineTree build_tree(Outline outline);

/// Whether a place of the leaf lies in the region.
bool is_inside(const Outline& outline, const Leaf& leaf, glm::dvec2 place);

}  // namespace tenebra::stage
