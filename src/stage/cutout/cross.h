// Twice the signed area that two vectors of the plane span.
#pragma once

#include <glm/glm.hpp>

namespace tenebra::stage {

/// Positive where `b` is to the left of `a`. Rounded as written.
inline double cross(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace tenebra::stage
