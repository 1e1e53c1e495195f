// Marching through the cells of a sheet: where the level line crosses the grid lines, and what lies between.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "stage/cutout/alpha_sheet.h"

namespace tenebra::stage {

/// The part of a grid edge at each end in which no crossing or gate lies.
constexpr double corner_gap = 1.0 / 256;

/// Where the level line crosses a grid line, and how far a simplified line may pass beside it. A line that
/// passes all gates of a loop in their order, between their ends, winds around the same grid points.
struct Gate {
  glm::dvec2 at{0.0};
  glm::dvec2 left{0.0};   ///< an end of the gate, on the region's side
  glm::dvec2 right{0.0};  ///< the other
  bool forced = false;    ///< stays a vertex
};

/// All crossings; the line runs from gate i to gate next[i], between them over the first `bend_count[i]` of
/// bends[i] (the vertices that a hyperbola far from its chord needs).
struct GateNet {
  std::vector<Gate> gates;
  std::vector<std::uint32_t> next;
  std::vector<std::uint32_t> first_bend;  ///< index into bends, one more than there are gates
  std::vector<glm::dvec2> bends;
  bool too_many = false;
};

/// `half_tolerance`: of a gate to each side, and of a hyperbola from its chords.
GateNet march(const AlphaSheet& sheet, double threshold, double half_tolerance, std::size_t most_gates);

/// The vertices of the hyperbola from `from` to `to`, the level line of a cell between two of its sides, so
/// that no chord is farther than `limit` from it. `corner` has the values at (low.x, low.y), (high.x, low.y),
/// (high.x, high.y), (low.x, high.y).
void bend_hyperbola(const std::array<double, 4>& corner, glm::dvec2 low, glm::dvec2 high, glm::dvec2 from,
                    glm::dvec2 to, double limit, std::vector<glm::dvec2>& out);

}  // namespace tenebra::stage
