// Points coordinate by coordinate, for tests of eight at once, and the kernels that groups are made with.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/simd_level.h>
#include "math/box.h"
#include "soft/groups/cell.h"

namespace tenebra::soft {

struct PointLanes {
  std::vector<double> x, y, z;     ///< world space; a multiple of eight of each
  std::vector<float> column, row;  ///< in the picture, counted from anywhere

  void resize(std::size_t count) {
    for (auto* values : {&x, &y, &z}) values->resize(count);
    for (auto* values : {&column, &row}) values->resize(count);
  }
  void put(std::size_t i, const glm::dvec3& p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
};

/// Which points are meant: bit k of byte i is point 8 i + k.
using PointSet = std::span<const std::uint8_t>;

/// A side of a box cut into equal slices.
struct Slices {
  static constexpr int count = 16;
  int axis = 0;
  double low = 0, scale = 0;  ///< slice: (coordinate - low) * scale, rounded down; the last includes its end
};

/// The same bits on every instruction set.
struct PointKernels {
  /// Puts eight points, which follow each other in memory, at places `first` to first + 7.
  void (*put_eight)(const glm::dvec3* from, PointLanes& to, std::size_t first) = nullptr;
  /// Bit k: whether value k of the 64 is `value`.
  std::uint64_t (*equal)(const std::uint32_t* values, std::uint32_t value) = nullptr;
  /// Bit k: whether point first + k of 64 may lie in front of the light's plane.
  std::uint64_t (*in_front)(const PointLanes& points, const LightShape& light, std::size_t first) = nullptr;
  math::Box<double> (*box)(const PointLanes& points, PointSet set) = nullptr;
  /// Bit k: slice k has a point.
  std::uint32_t (*taken)(const PointLanes& points, PointSet set, const Slices& slices) = nullptr;
  /// Bit k: whether point k of 64 lies below the slice `end`.
  std::uint64_t (*below)(const PointLanes& points, const Slices& slices, int end) = nullptr;
  /// A cell around points with the bounds `box`, whose first two axes follow the picture's rows and columns:
  /// for points of one plane it is flat, and little larger than their hull. Falls back to the box where rows
  /// and columns run almost the same way.
  Cell (*fitted_cell)(const PointLanes& points, PointSet set, const math::Box<double>& box,
                      const LightShape& light) = nullptr;
  /// The least m.(p - light.origin).
  double (*lowest)(const PointLanes& points, PointSet set, const glm::dvec3& m,
                   const LightShape& light) = nullptr;
};
PointKernels point_kernels(SimdLevel level);

}  // namespace tenebra::soft
