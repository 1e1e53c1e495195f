#include "stage/places.h"

#include <fmt/core.h>

#include <cmath>

namespace tenebra::stage {

std::string coordinate_text(double value) {
  return std::abs(value) < 1000 ? fmt::format("{:.6g}", value) : fmt::format("{:.3f}", value);
}

std::string place_text(const FileFrame& frame, const glm::dvec3& place) {
  const glm::dvec3 p = frame.to_file(place);
  return coordinate_text(p.x) + "," + coordinate_text(p.y) + "," + coordinate_text(p.z);
}

}  // namespace tenebra::stage
