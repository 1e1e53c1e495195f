// The lights in the view: circles that move them, arrows along the axes, and a tip that turns them.
#pragma once

#include "window/panels/stage.h"

namespace tenebra::viewer {

/// The parts of a light that the mouse can drag.
enum class LightPart { place, aim, x, y, z };
struct LightHandle {
  int light = -1;  ///< -1: none
  LightPart part = LightPart::place;
};

/// Draws the handles and returns the one under the pointer. The selected light has arrows and, where it has a
/// direction, a tip.
LightHandle draw_light_handles(Ui& ui, const Stage& stage, ImVec2 pointer);
/// One frame of dragging a handle. A place moves in the plane through it that faces the view, by the wheel
/// along the line of sight; an arrow moves it along an axis of the world; a tip turns it.
void drag_light(Ui& ui, const Stage& stage, LightHandle handle, ImVec2 pointer);

}  // namespace tenebra::viewer
