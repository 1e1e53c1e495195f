// Whether two triangles are one surface to the eye.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/frame_geometry.h>

namespace tenebra::render {

/// Answers for one instant and view; each thread has its own. A pixel whose samples see one surface needs one
/// sample for its geometry; shading covers the differences between them.
class SurfaceMatch {
public:
  SurfaceMatch(const FrameGeometry& geometry, const ViewRays& view);

  /// Whether triangles `a` and `b`, or no triangle, are one surface around a place of the window (pixels):
  /// the same id; or the same material, normals less than 18 degrees apart, and planes that meet within a
  /// pixel of the place, so that the triangles bound each other there (or might). The order of a and b does
  /// not matter.
  bool same(std::uint32_t a, std::uint32_t b, glm::vec2 place);

private:
  struct Plane {
    glm::vec3 normal{0.0f};  // any length
    float height = 0;        // normal . (point of the plane - eye)
  };
  struct Known {
    std::uint32_t id = 0xffffffffu;
    Plane plane;
  };
  Plane plane_of(std::uint32_t id) const;
  const Plane& known_plane(std::uint32_t id);

  std::array<Known, 64> known_;  // planes of triangles asked about lately
  const FrameGeometry& geometry_;
  const ViewRays& view_;
};

}  // namespace tenebra::render
