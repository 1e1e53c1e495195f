// Sixteen rays, the unit in which fields are looked up and casters asked.
#pragma once

#include <glm/glm.hpp>

namespace tenebra::trees {

inline constexpr int batch_size = 16;

/// Sixteen rays, coordinate by coordinate. A point of ray i is origin + t direction; distances are values of
/// t, so a unit direction gives lengths, and an affine map of origin and direction leaves t as it is.
/// Rays that a batch has no use for get a zero direction: they meet nothing.
struct alignas(64) RayBatch {
  float ox[batch_size], oy[batch_size], oz[batch_size];
  float dx[batch_size], dy[batch_size], dz[batch_size];

  void set(int i, glm::vec3 origin, glm::vec3 direction) {
    ox[i] = origin.x, oy[i] = origin.y, oz[i] = origin.z;
    dx[i] = direction.x, dy[i] = direction.y, dz[i] = direction.z;
  }
  glm::vec3 origin(int i) const { return {ox[i], oy[i], oz[i]}; }
  glm::vec3 direction(int i) const { return {dx[i], dy[i], dz[i]}; }
};

}  // namespace tenebra::trees
