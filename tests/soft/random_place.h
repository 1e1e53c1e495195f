// Where lights of the generated cases stand.
#pragma once

#include <cmath>

#include "support/seeded_random.h"
#include "support/soup.h"

namespace tenebra::testing {

/// A centre and two half axes, square to each other, of any length.
struct RandomPlace {
  glm::dvec3 x, y;
  glm::vec3 centre;
};
/// In or about the box of the soup.
inline RandomPlace random_place(Random& random, const Soup& soup) {
  const glm::dvec3 low = soup.low(), high = soup.high();
  const double size = glm::length(high - low);
  RandomPlace place;
  place.x = random.direction() * size * std::exp2(random.in(-6, -1));
  place.y = glm::normalize(glm::cross(place.x, random.direction())) * size * std::exp2(random.in(-6, -1));
  place.centre = glm::vec3(0.5 * (low + high) + random.direction() * size * random.in(0.0, 1.0));
  return place;
}

}  // namespace tenebra::testing
