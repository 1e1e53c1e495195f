// Triangles that fill a region with holes, without a vertex more.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace tenebra::stage {

using Loop = std::vector<std::uint32_t>;  ///< indices of points, closed

/// Loops with the region to their left: outer ones counter-clockwise, holes clockwise; they must not cross.
/// Every vertex of a loop is a corner of triangles (no T-junctions), and every triangle is counter-clockwise
/// but for rounding. Takes any input: loops that do cross give some triangles, in finite time.
std::vector<glm::uvec3> triangulate(std::span<const glm::dvec2> points, std::vector<Loop> loops);

}  // namespace tenebra::stage
