// The triangles of one mesh at its node, in a frame.
#pragma once

#include <cstddef>

#include <tenebra/frame_geometry.h>

namespace tenebra::scene {

/// Triangles [first, end) of a frame.
struct TriangleRange {
  std::size_t first = 0, end = 0;
};

/// `part`: below frame.parts.size(), which counts the nodes with a mesh in the order of the scene.
inline TriangleRange triangles_of_part(const FrameGeometry& frame, std::size_t part) {
  return {frame.parts[part], part + 1 < frame.parts.size() ? frame.parts[part + 1] : frame.triangles.size()};
}

}  // namespace tenebra::scene
