#include "soft/shaft.h"

#include <cassert>

namespace tenebra {

using glm::dvec3;

LightShape::LightShape(const AreaLight& light) : origin(light.centre), normal(light.normal) {
  for (const glm::dvec2& v : light.outline) {
    assert(count < most_light_vertices);
    vertices[count] = v.x * light.ex + v.y * light.ey;
    reach = std::max(reach, largest(vertices[count]));
    low = count == 0 ? vertices[0] : glm::min(low, vertices[count]);
    high = count == 0 ? vertices[0] : glm::max(high, vertices[count]);
    ++count;
  }
  for (int k = 0; k < count; ++k) {
    const dvec3 o = glm::cross(vertices[k + 1 < count ? k + 1 : 0] - vertices[k], normal);
    for (int axis = 0; axis < 3; ++axis) across[axis][k] = o[axis];
    at_edge[k] = glm::dot(o, vertices[k]);
  }
}

Cell box_cell(const dvec3& low, const dvec3& high, const LightShape& light) {
  Cell cell;
  cell.centre = 0.5 * (low + high) - light.origin;
  const dvec3 half = 0.5 * (high - low);
  cell.axis = {dvec3(half.x, 0, 0), dvec3(0, half.y, 0), dvec3(0, 0, half.z)};
  cell.slack = 0x1p-50 * (largest(low) + largest(high) + largest(light.origin));
  cell.reach = largest(cell.centre) + largest(half) + cell.slack;
  return cell;
}

}  // namespace tenebra
