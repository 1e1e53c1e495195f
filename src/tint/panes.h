// The see-through triangles of a frame, and the share of light that each lets pass.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/tint.h>

namespace tenebra::tint {

/// The see-through triangles of a frame, numbered from 0 in the order of their ids.
class Panes {
public:
  void reset(const SeeThroughSurfaces& surfaces, const TriangleView& triangles);

  std::span<const std::uint32_t> ids() const { return ids_; }
  /// Whether the transmittance of `number` is not the same all over it.
  bool varies(std::uint32_t number) const { return varies_[number] != 0; }
  glm::vec3 constant(std::uint32_t number) const { return constant_[number]; }
  /// At the place with the weights `at` of its corners.
  glm::vec3 transmittance(std::uint32_t number, const glm::dvec3& at) const;

private:
  void add(std::uint32_t id);

  SeeThroughSurfaces surfaces_;
  TriangleView triangles_;
  std::vector<std::uint8_t> textured_;  ///< for each material
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint8_t> varies_;
  std::vector<glm::vec3> constant_;
};

/// Weights of a triangle's corners at the place of its plane that the line from `from` along `along` meets,
/// clamped into the triangle; the sum is 1.
glm::dvec3 weights_where(const glm::vec3 corners[3], const glm::dvec3& from, const glm::dvec3& along);

}  // namespace tenebra::tint
