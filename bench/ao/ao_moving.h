// Which triangles of a scene differ between two frames, and how near a point they come.
#pragma once

#include <memory>
#include <vector>

#include <tenebra/frame_geometry.h>
#include "bench/common/bench_embree.h"

namespace tenebra::bench {

class MovingTriangles {
public:
  MovingTriangles(const FrameGeometry& now, const FrameGeometry& next);
  /// One for each triangle: not the same floats in both frames.
  const std::vector<bool>& moves() const { return moves_; }
  /// Whether a moving triangle lies nearer than `distance` in one of the frames.
  bool within(const glm::dvec3& point, double distance) const;

private:
  std::vector<bool> moves_;
  std::vector<glm::vec3> corners_;  ///< three for each moving triangle, of both frames
  std::vector<glm::uvec3> triangles_;
  std::unique_ptr<EmbreeScene> scene_;  ///< null: nothing moves
};

}  // namespace tenebra::bench
