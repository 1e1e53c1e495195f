#pragma once

#include <glm/glm.hpp>

namespace tenebra::ao {

struct Sphere {
  glm::dvec3 centre{0.0};
  double radius = 0;
};

}  // namespace tenebra::ao
