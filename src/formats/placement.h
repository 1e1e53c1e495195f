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

/// The frame of a file whose geometry lies at `points`, relative to `carriers`, in the file's coordinates; an
/// automatic offset is math::whole_origin of these.
FileFrame choose_frame(const Placement& placement, const FormatCoordinates& format,
                       std::span<const glm::dvec3> points, std::span<const glm::dvec3> carriers = {});

}  // namespace tenebra::formats
