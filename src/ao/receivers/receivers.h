// Points that ambient light falls on: a visible point with its normals, the body it lies on and where on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "ao/objects/surface_point.h"

namespace tenebra::ao {

struct Receiver {
  glm::dvec3 position{0.0};  ///< world
  glm::dvec3 local{0.0};     ///< in the space of its object; world for what stands or deforms
  glm::vec3 normal{0.0f};    ///< world, unit, of shading
  glm::vec3 face{0.0f};      ///< world, unit, of the triangle, on the same side
  TriangleOwner owner;
  float v = 0, w = 0;  ///< barycentric weights of the second and third corner
  bool front = true;   ///< seen from where the shape's triangle runs counter-clockwise
  SurfacePoint on_shape() const { return {owner.triangle, v, w, front}; }
  std::size_t index = 0;  ///< of the result
};

/// Makes receivers; cheap for a run of points on one triangle.
class ReceiverMaker {
public:
  ReceiverMaker(const FrameGeometry& geometry, const SceneObjects& objects)
      : geometry_(geometry), objects_(objects) {}

  static constexpr std::size_t most_fetched = 16;
  /// Loads the triangles of points (at most most_fetched) about to be made, in their order: memory is slow,
  /// and here the waits for many overlap instead of following each other.
  void fetch(std::span<const std::uint32_t> triangles);

  /// False where there is none: no triangle, no area, no normal, or a point that is not finite. A free point
  /// lies on a surface across its normal that hides nothing.
  bool make(std::uint32_t triangle, const glm::dvec3& position, const glm::vec3& normal, Receiver& out);

private:
  /// A triangle in the space of its object.
  struct Fetched {
    std::uint32_t id = 0;
    TriangleOwner owner;
    const std::vector<glm::vec3>* positions = nullptr;
    glm::uvec3 corners{0};
    glm::vec3 at[3];
  };
  std::span<Fetched> fetched() { return {fetched_, fetched_count_}; }
  void look_up(Fetched& triangle) const;
  void take(const Fetched& triangle);
  static bool make_free(const glm::dvec3& position, const glm::vec3& normal, Receiver& out);

  const FrameGeometry& geometry_;
  const SceneObjects& objects_;
  Fetched fetched_[most_fetched];
  std::size_t fetched_count_ = 0, next_ = 0;  ///< of fetched_
  std::uint32_t triangle_ = 0xffffffffu;
  TriangleOwner owner_;
  const glm::dmat4* to_object_ = nullptr;
  glm::dvec3 a_{0.0}, du_{0.0}, dv_{0.0};
  glm::vec3 face_{0.0f};  ///< world, unit; zero: no area
};

}  // namespace tenebra::ao
