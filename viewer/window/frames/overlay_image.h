// Pictures that explain a picture: the heat map of nodes, the classes of the soft shadows.
#pragma once

#include "window/frames/frame_request.h"

namespace tenebra::viewer {

/// The overlay of what `result`, drawn with diagnostics, holds; `kind` none where it has none of that kind.
OverlayImage make_overlay(Overlay kind, const render::FrameResult& result);

/// Colour of 0..1 of the heat map: dark violet over red to light yellow.
glm::u8vec3 heat_color(double part);
/// Colour and name of a SoftClass.
glm::u8vec3 class_color(SoftClass soft_class);
const char* class_name(SoftClass soft_class);

}  // namespace tenebra::viewer
