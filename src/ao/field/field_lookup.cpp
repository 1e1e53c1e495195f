#include "ao/field/field_lookup.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>

namespace tenebra::ao {

namespace {

/// Rows of x -> linear x + offset as floats; false if one is not finite.
bool set_rows(float rows[3][4], const glm::dmat3& linear, glm::dvec3 offset) {
  for (int row = 0; row < 3; ++row) {
    const glm::dvec4 all(glm::row(linear, row), offset[row]);
    for (int k = 0; k < 4; ++k) {
      rows[row][k] = static_cast<float>(all[k]);
      if (!std::isfinite(rows[row][k])) return false;
    }
  }
  return true;
}

/// At least the longest half axis of the ellipsoid that `linear` makes of the unit sphere: no eigenvalue of
/// L^T L exceeds the largest sum of a row (Gershgorin). Exact where the axes stay at right angles.
double longest_axis(const glm::dmat3& linear) {
  const glm::dmat3 square = glm::transpose(linear) * linear;
  double largest = 0;
  for (int row = 0; row < 3; ++row) {
    const glm::dvec3 r = glm::abs(glm::row(square, row));
    largest = std::max(largest, r.x + r.y + r.z);
  }
  return std::sqrt(largest);
}

}  // namespace

std::optional<FieldInstance> place_field(const DisplacementField& field, const trees::TriangleBvh* near,
                                         const glm::dmat4& world_from_object, FieldEnds ends) {
  FieldInstance instance{.field = &field, .near = near, .ends = ends};
  const glm::dmat3 linear(world_from_object);
  const glm::dvec3 origin(world_from_object[3]);
  const glm::dmat3 object_from_world = glm::inverse(linear);
  const glm::dvec3 centre = linear * field.bound.centre + origin, axes = field.bound.axes;
  const glm::dmat3 unit_from_object(1 / axes.x, 0, 0, 0, 1 / axes.y, 0, 0, 0, 1 / axes.z);
  const glm::dmat3 unit_from_world = unit_from_object * object_from_world;
  if (!set_rows(instance.unit_from_world, unit_from_world, -(unit_from_world * centre)) ||
      !set_rows(instance.object_from_world, object_from_world, -(object_from_world * origin)))
    return std::nullopt;
  instance.world = {centre, longest_axis(linear * glm::inverse(unit_from_object))};
  return instance;
}

}  // namespace tenebra::ao
