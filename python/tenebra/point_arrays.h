// Points of a caller's, as arrays.
#pragma once

#include <tenebra/queries.h>

#include "arrays.h"

namespace tenebra::python {

struct PointArrays {
  Array<double> positions;
  MaybeArray<std::uint32_t> triangles;
  MaybeArray<float> normals;
  MaybeArray<std::int8_t> sides;
  int width = 0;

  QueryPoints query() const {
    return {.positions = vectors<glm::dvec3>(positions),
            .triangles = values(triangles),
            .normals = vectors<glm::vec3>(normals),
            .sides = values(sides),
            .width = width};
  }
};

}  // namespace tenebra::python
