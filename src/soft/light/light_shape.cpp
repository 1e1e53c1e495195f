#include "soft/light/light_shape.h"

#include <cassert>

namespace tenebra::soft {

using glm::dvec3;

LightShape::LightShape(const AreaLight& light)
    : origin(light.at_infinity ? dvec3(0) : light.centre),
      normal(light.normal),
      weight(light.at_infinity ? 0 : 1),
      middle(light.centre - origin) {
  for (const glm::dvec2& v : light.polygon) {
    assert(count < most_light_vertices);
    vertices[count] = middle + (v.x * light.ex + v.y * light.ey);
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

}  // namespace tenebra::soft
