// Lights of the scene as the shadow tracer sees them.
#pragma once

#include <tenebra/frame_geometry.h>
#include <tenebra/hard_shadows.h>
#include <tenebra/scene.h>

namespace tenebra::render {

/// Point, spot and directional lights as they are; an area light is its centre, shining to its front.
ShadowLight shadow_light(const Light& light, const WorldLight& placed);

}  // namespace tenebra::render
