// From world positions to triangles set up, several at a time. Internal to visibility.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include <tenebra/simd_level.h>
#include "visibility/records.h"
#include "visibility/window.h"

namespace tenebra::visibility {

/// Code for one instruction set; all give the same bits.
struct SetupKernels {
  /// Fills vertices first ... last - 1 of `out`.
  void (*place)(const Window& window, std::span<const glm::vec3> positions, std::size_t first,
                std::size_t last, WindowVertices& out) = nullptr;
  /// Writes those of sixteen triangles (fewer: repeat one) starting with `id` that may cover a pixel's centre
  /// to `out` from `begin` on, which has room for sixteen more. `wanted`: bit k: consider triangle k. Returns
  /// how many.
  std::size_t (*choose)(const Window& window, const WindowVertices& vertices, const glm::uvec3* triangles,
                        std::uint32_t id, std::uint32_t wanted, std::size_t begin, Candidates& out) = nullptr;
  /// `corners`: [corner][coordinate][triangle]; `x0`, `y0`: first pixels of the triangles' boxes.
  void (*set_up)(const Window& window, const float (&corners)[3][3][8], const double (&x0)[8],
                 const double (&y0)[8], TriangleSetup8& out) = nullptr;
};
SetupKernels setup_kernels(SimdLevel level);

}  // namespace tenebra::visibility
