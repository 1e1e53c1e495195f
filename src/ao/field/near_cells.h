// Which places are too close to an object for its field to resolve: one bit per cell of a grid in unit space.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "ao/field/displacement_field.h"

namespace tenebra::ao {

inline constexpr int near_side = 64;  ///< cells along each side of the cube -1..1
inline constexpr std::size_t near_words = near_side * near_side * near_side / 32;

/// Bit i % 32 of word i / 32, i = (z * side + y) * side + x, is set if a point of the cell is nearer than
/// `reach` to a triangle (unit space), and for some cells a little farther away.
std::vector<std::uint32_t> close_cells(std::span<const glm::vec3> positions,
                                       std::span<const glm::uvec3> triangles, const Ellipsoid& bound,
                                       float reach);

}  // namespace tenebra::ao
