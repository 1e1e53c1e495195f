// Vertices between those of a mesh, with everything that a vertex has.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include <tenebra/scene.h>
#include "stage/cutout/cut_triangle.h"

namespace tenebra::stage {

/// Adds vertices to a mesh. Values are mixed in double and rounded once; normals and tangents are unit again;
/// of the skin's joints the eight with most weight stay, scaled to the sum that all had.
class NewVertices {
public:
  explicit NewVertices(Mesh& mesh) : mesh_(mesh) {}

  /// The index of `vertex` of triangle `triangle`: a corner's own, one that an edge already has there, or a
  /// new one.
  std::uint32_t add(const glm::uvec3& triangle, const CutVertex& vertex);

  std::size_t lost_joints() const { return lost_joints_; }  ///< vertices that would have had more than eight

private:
  std::uint32_t append(const std::array<std::uint32_t, 3>& from, const CutVertex& vertex);
  void append_joints(const std::array<std::uint32_t, 3>& from, const CutVertex& vertex);

  Mesh& mesh_;
  std::map<std::array<std::uint64_t, 3>, std::uint32_t> on_edges_;
  std::size_t lost_joints_ = 0;
};

}  // namespace tenebra::stage
