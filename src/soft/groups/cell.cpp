#include "soft/groups/cell.h"

namespace tenebra::soft {

using glm::dvec3;

Cell box_cell(const dvec3& low, const dvec3& high, const LightShape& light) {
  Cell cell;
  cell.centre = 0.5 * (low + high) - light.origin;
  const dvec3 half = 0.5 * (high - low);
  cell.axis = {dvec3(half.x, 0, 0), dvec3(0, half.y, 0), dvec3(0, 0, half.z)};
  cell.slack = 0x1p-50 * (largest(low) + largest(high) + largest(light.origin));
  cell.reach = largest(cell.centre) + largest(half) + cell.slack;
  return cell;
}

}  // namespace tenebra::soft
