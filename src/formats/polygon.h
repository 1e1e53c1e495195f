// Polygons of a file cut into triangles.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/scene.h>

namespace tenebra::formats {

/// Corner tests of all polygons of a file: about half a second.
inline constexpr std::uint64_t most_polygon_work = 300'000'000;
/// Corners of one polygon; callers refuse more.
inline constexpr std::size_t most_polygon_corners = std::size_t{1} << 20;

/// Corner triples (indices into `corners`) of the polygon by ear clipping in its mean plane: concave polygons
/// are not overrun; always corners.size() - 2 of them, turning as the polygon does. Self-crossing polygons
/// get some triangulation. Adds the number of corner tests to `work`; beyond most_polygon_work it cuts
/// without looking for ears, and the caller refuses.
std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners, std::uint64_t& work);

/// Adds the triangles of a polygon of three or more of the mesh's vertices. Throws ImportFailure
/// beyond most_polygon_corners, and where `work`, the corner tests of all polygons, exceeds
/// most_polygon_work.
void add_polygon(std::span<const std::uint32_t> corners, std::uint64_t& work, Mesh& mesh);

}  // namespace tenebra::formats
