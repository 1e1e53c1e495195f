// A camera for a closed room, which shows nothing of itself from outside.
#pragma once

#include <optional>

#include "stage/framing.h"

namespace tenebra::stage {

/// A camera near a wall or in a corner, looking through the room, and a place for a lamp. None where the
/// subject, at the start, is no closed room. One is, if
/// - from its sides it fills the rectangles of its box (four fifths of them): walls and ceiling are level;
/// - from outside most of it shows its back, also on the side with the largest opening, or it is a plain box:
///   nine tenths lie on the box's sides;
/// - from inside, where the camera stands, nine tenths of all directions meet the front of something.
/// A solid box is none by the last, a statue turned inside out by the first.
std::optional<Framing> frame_room(const Subject& subject, std::optional<float> aspect);

}  // namespace tenebra::stage
