#include "ao/field_lookup.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>

namespace tenebra {

std::optional<FieldInstance> place_field(const DisplacementField& field, const glm::dmat4& world_from_object,
                                         FieldEnds ends) {
  const glm::dmat3 linear(world_from_object);
  const glm::dvec3 centre(world_from_object * glm::dvec4(field.sphere.centre, 1));
  const glm::dmat3 unit_from_world = glm::inverse(linear) / field.sphere.radius;
  FieldInstance instance{.field = &field, .ends = ends};
  for (int row = 0; row < 3; ++row) {
    const glm::dvec3 r = glm::row(unit_from_world, row);
    const glm::dvec4 all(r, -glm::dot(r, centre));
    for (int k = 0; k < 4; ++k) {
      instance.unit_from_world[row][k] = static_cast<float>(all[k]);
      if (!std::isfinite(instance.unit_from_world[row][k])) return std::nullopt;
    }
  }
  // The longest axis of the ellipsoid: no eigenvalue of L^T L exceeds a row's sum (Gershgorin); for
  // rotations with one scale the bound is exact.
  const glm::dmat3 square = glm::transpose(linear) * linear;
  double largest = 0;
  for (int row = 0; row < 3; ++row) {
    const glm::dvec3 r = glm::abs(glm::row(square, row));
    largest = std::max(largest, r.x + r.y + r.z);
  }
  instance.world = {centre, field.sphere.radius * std::sqrt(largest)};
  return instance;
}

}  // namespace tenebra
