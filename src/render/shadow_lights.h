// Lights of the scene as the shadow tracer sees them.
#pragma once

#include "scene/frame_geometry.h"
#include "scene/scene.h"
#include "shadow/mask.h"

namespace tenebra {

/// Point, spot and directional lights as they are; an area light is its centre, shining to its front.
ShadowLight shadow_light(const Light& light, const WorldLight& placed);

}  // namespace tenebra
