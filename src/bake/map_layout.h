// Where in a lightmap each mesh at its node lies.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace tenebra::bake {

/// A square of the map, in texels: (u, v) of a mesh lies at origin + side * (u, v).
struct MapSquare {
  glm::dvec2 origin{0.0};
  double side = 0;
};

/// Squares that do not overlap for surfaces of these areas, in m2, in a map of `size` x `size` texels, with a
/// texel and a half to spare around each. Sides are the map's, halved some times, and as near to the same
/// texels per metre as that allows. None: there is no room for squares of 8 texels; 0 areas get none and a
/// side of 0.
std::optional<std::vector<MapSquare>> lay_out(std::span<const double> areas_m2, int size);

}  // namespace tenebra::bake
