// What building, looking up and storing a field have in common.
#pragma once

#include "ao/field/displacement_field.h"

namespace tenebra::ao {

inline constexpr std::size_t field_padding = 3;  ///< so that four bytes can be read at any entry
inline constexpr float no_hit = 2.0f;

/// In unit space: from `entry` on the sphere, `along` to the exit.
struct Chord {
  glm::vec3 entry, along;
};
/// The chord that entry (position, direction) of the table stands for.
Chord sample_chord(const DisplacementField& field, std::size_t position, std::size_t direction);

/// A field of this shape, all of it zero.
DisplacementField empty_field(const FieldSettings& settings, const FieldShape& shape);

}  // namespace tenebra::ao
