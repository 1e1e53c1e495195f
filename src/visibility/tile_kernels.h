// Triangles into the pixels of a tile, sixteen at a time. Internal to visibility.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <tenebra/simd_level.h>
#include "visibility/exact_coverage.h"
#include "visibility/records.h"

namespace tenebra::visibility {

/// Whether triangle `id` covers a pixel whose centre is too close to an edge for floats.
struct CloseCalls {
  const ExactCoverage& coverage;
  std::span<const glm::vec3> positions;
  std::span<const glm::uvec3> triangles;

  bool covers(std::uint32_t id, const glm::dvec2& place) const {
    const glm::uvec3 t = triangles[id];
    return coverage.meets(positions[t.x], positions[t.y], positions[t.z], place);
  }
  bool covers(std::uint32_t id, int x, int y) const { return covers(id, {x + 0.5, y + 0.5}); }
};

/// Code for one instruction set; all give the same bits.
struct TileKernels {
  /// Draws records `order[0]` ... `order[count - 1]` into the tile whose first pixel is (left, top). Their
  /// order does not matter: the nearest is kept, the smaller id where depths are equal, and where an id is -1
  /// only what is nearer.
  void (*draw)(const TileRecord* records, const std::uint32_t* order, std::size_t count, int left, int top,
               const CloseCalls& close, Tile& tile) = nullptr;
};
TileKernels tile_kernels(SimdLevel level);

}  // namespace tenebra::visibility
