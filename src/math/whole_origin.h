// What is subtracted from coordinates in double before they become floats.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace tenebra::math {

/// An origin of whole numbers for geometry at `points` (any order; NaN and beyond 1.8e18: ignored).
/// `carriers`: places to which parts of it are relative, the first preferred. The origin
/// - is zero where floats are fine: where rounding moves no coordinate by more than 2^-21 of the longest side
///   of the points' bounds;
/// - else is a carrier, rounded to whole numbers, from which floats are fine;
/// - else is the multiple of a round number (1, 2 or 5 times a power of ten, just above the longest side)
///   nearest to the middle. So equal geometry at round places gets equal floats.
/// Where floats are fine for the bounds alone, as a stray point makes them large, and rounding would move
/// most points by half a millimetre, the bounds are those of all but the 2 % at each end of each axis.
glm::dvec3 whole_origin(std::span<const glm::dvec3> points, std::span<const glm::dvec3> carriers = {},
                        double metres_per_unit = 1);

}  // namespace tenebra::math
