#include "formats/placement.h"

#include "math/whole_origin.h"

namespace tenebra::formats {

FileFrame choose_frame(const Placement& placement, const FormatCoordinates& format,
                       std::span<const glm::dvec3> points, std::span<const glm::dvec3> carriers) {
  FileFrame frame;
  frame.up = placement.up.value_or(format.up);
  frame.metres_per_unit = placement.metres_per_unit.value_or(format.metres_per_unit);
  if (placement.offset == OffsetChoice::given) frame.origin = placement.given_offset;
  if (placement.offset == OffsetChoice::automatic)
    frame.origin = math::whole_origin(points, carriers, frame.metres_per_unit);
  return frame;
}

}  // namespace tenebra::formats
