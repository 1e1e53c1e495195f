// The floor under a scene that has none: it shows the shadow, and nothing of itself.
#pragma once

#include <tenebra/scene.h>
#include "stage/subject.h"

namespace tenebra::stage {

/// Whether three quarters of the ground, under the scene and its shadow, are covered by what faces up within
/// a tenth of the scene's height from below.
bool has_floor(const Subject& subject);

/// Adds a round floor at the height `floor_y`, in metres in the scene's coordinates, as the scene's last mesh
/// and node, and says so in scene.warnings. In the added sun it is as bright as the ground of the soft sky;
/// it casts no shadow. Around the shadow of a sun 30 degrees high, from whichever side, it fades out, so that
/// no edge shows in other light either.
void add_shadow_floor(Scene& scene, const Subject& subject, double floor_y);

}  // namespace tenebra::stage
