// The materials of a scene and what they need of each vertex, as shading reads them.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>

namespace tenebra::shade {

/// One material, resolved.
struct Surface {
  glm::vec3 base{0.0f};
  glm::vec3 ambient{0.0f};
  glm::vec3 emissive{0.0f};
};

/// Made once a scene.
class SurfaceTable {
public:
  SurfaceTable() = default;
  explicit SurfaceTable(std::span<const Material> materials);

  /// Indices beyond the last material mean the last; without any, everything is black.
  const Surface& operator[](std::size_t material) const { return surfaces_[held(material)]; }
  std::size_t held(std::size_t material) const { return std::min(material, surfaces_.size() - 1); }
  std::size_t size() const { return surfaces_.size(); }

private:
  std::vector<Surface> surfaces_{1};
};

}  // namespace tenebra::shade
