// The line along which alpha passes its threshold, as closed loops of straight segments.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "stage/cutout/alpha_sheet.h"

namespace tenebra::stage {

/// Closed loops around the region where the sheet's alpha is at least the threshold; the region lies to the
/// left of each segment points[i] -> points[next[i]], x to the right and y up. Loops do not cross or touch
/// themselves or each other. The sheet's border belongs to the loops: outside of the sheet is nothing.
struct Outline {
  std::vector<glm::dvec2> points;
  std::vector<std::uint32_t> next;
  bool too_long = false;  ///< more crossings than `most_gates`: no loops
};

/// More crossings of grid lines than this are given up: half a gigabyte of work.
constexpr std::size_t most_gates = std::size_t{1} << 21;

/// The level line within `tolerance` (in the sheet's units, that is pixels): no point of a loop is farther
/// from the line where alpha equals `threshold`, and no point of that line is farther from a loop, but for
/// loops that fit into a square of half the tolerance: these are left out.
Outline trace_outline(const AlphaSheet& sheet, double threshold, double tolerance);

}  // namespace tenebra::stage
