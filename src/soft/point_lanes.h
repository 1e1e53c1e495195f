// The points of a group coordinate by coordinate, for tests of eight at once.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "soft/point_groups.h"

namespace tenebra {

struct PointLanes {
  std::size_t count = 0;                 ///< a multiple of 16: the last ones are copies of the first
  std::vector<double> x, y, z;           ///< relative to an origin
  std::vector<double> column, row;       ///< of the picture, from the points' mean; of copies 0
  std::vector<std::uint32_t> triangles;  ///< that the points lie on

  /// Replaces the points by those of a group.
  void take(const PointGroups& groups, const PointGroup& group, const glm::dvec3& origin);

private:
  void put(std::size_t i, const PointGroups& groups, std::uint32_t pixel, const glm::dvec3& origin);
};

}  // namespace tenebra
