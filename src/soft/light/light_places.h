// Places spread over an area light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/area_light.h>
#include <tenebra/hard_config.h>

namespace tenebra::soft {

/// A map of the unit square onto the light's polygon: equal areas of the square become equal areas of the
/// light.
class LightPlaces {
public:
  explicit LightPlaces(const AreaLight& light);

  /// `across`, `along`: 0..1. World space; for a sun a direction.
  glm::vec3 at(double across, double along) const;
  const AreaLight& light() const { return *light_; }
  double area() const { return area_; }  ///< of the polygon, in square units of its coordinates

private:
  /// Part of the polygon between two neighbouring vertices in x: a trapezoid.
  struct Slab {
    double x, step;       ///< from x to x + step
    double width, slope;  ///< of the chord at x, and its growth with x
    double area() const { return step * (width + 0.5 * slope * step); }
    double x_at(double part) const;  ///< where the area from the left is `part`
  };
  const AreaLight* light_;
  std::vector<Slab> slabs_;
  double area_ = 0;
};

/// The light without an area at a place of `light`: a point light, or a directional one for a sun.
ShadowLight light_at(const AreaLight& light, const glm::vec3& place);

/// Place `index` of Sobol's sequence in the unit square (Bratley and Fox 1988): of any 2^m consecutive places
/// that begin at a multiple of 2^m, one lies in each cell of every grid of 2^a by 2^(m-a) cells, none on an
/// edge.
glm::dvec2 sobol_place(std::uint32_t index);

/// The half, 0 or 1, of a phase's tally that the k-th of `more` of its places is in. These are consecutive
/// ones of Sobol's sequence, a power of two, one phase's after another's. Two of a half's 2^m places lie in
/// each cell of every grid of 2^(m-1) cells, and so do two of those that all phases have in half 0, or in
/// half 1: the halves differ by noise, and not by what is seen, say, from the light's left and from its
/// right.
std::size_t half_of_place(std::uint32_t phase, std::uint32_t k, std::uint32_t more);

}  // namespace tenebra::soft
