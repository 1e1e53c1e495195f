// How a file's coordinates become a scene's: which axis is up, the unit, and what is subtracted before
// anything becomes a float.
#pragma once

#include <optional>
#include <span>

#include <tenebra/scene.h>

namespace tenebra::formats {

enum class OffsetChoice { automatic, none, given };

/// What the user says about a file's coordinates.
struct Placement {
  std::optional<UpAxis> up = {};               ///< none: the format's own
  std::optional<double> metres_per_unit = {};  ///< above 0; none: the format's own
  OffsetChoice offset = OffsetChoice::automatic;
  glm::dvec3 given_offset{0.0};  ///< finite, in the file's coordinates
};

/// What a format says about the coordinates of all its files.
struct FormatCoordinates {
  UpAxis up = UpAxis::y;
  double metres_per_unit = 1;
};

/// The frame of a file whose geometry lies at `points` (any order; not finite: ignored). `carriers`: places
/// in the file to which geometry is relative, such as nodes, the first preferred. All in the file's
/// coordinates. The origin that is chosen automatically
/// - is zero where floats are fine: where rounding moves no coordinate by more than 2^-21 of the longest side
///   of the points' bounds;
/// - else is a carrier, rounded to whole numbers, from which floats are fine; so what stands there gets the
///   numbers that it has in the file;
/// - else is the multiple of a round number (1, 2 or 5 times a power of ten, just above the longest side)
///   nearest to the middle.
/// Where floats are fine for the bounds alone, as a stray point makes them large, and rounding would move
/// most points by half a millimetre, the bounds are those of all but the 2 % at each end of each axis.
FileFrame choose_frame(const Placement& placement, const FormatCoordinates& format,
                       std::span<const glm::dvec3> points, std::span<const glm::dvec3> carriers = {});

}  // namespace tenebra::formats
