// What light a scene gets that neither its file nor the user gives it, and how its pictures are exposed.
#pragma once

#include "session/staged_scene.h"

namespace tenebra::session {

/// Whether the file says how bright it is all around: an ambient light or a background of its own.
bool states_surroundings(const Scene& scene);

/// Whether a light of the scene is given in candela, lux or nits.
bool has_units(const Scene& scene);

/// Whether some emissive mesh can be a light, as the first clip begins, which decides what is added.
bool any_mesh_shines(const Scene& scene);

/// The light to add that `automatic` stands for, where the scene is to have none: none where the user adds
/// lights, an environment, or has emissive meshes shine.
stage::Sky wanted_sun(const settings::SceneSettings& settings, const Scene& scene, bool environment);

/// Lights what lamps with units and emissive meshes do not reach, where the file states no surroundings
/// (Sky::automatic), or any scene (Sky::soft): by a grey sky that shows 0.12 where white faces it,
/// at most 0.14 where an exposure of 1 will do. With
/// Sky::none emissive meshes shine alone. Then sets the exposure of scenes whose brightness is not known: of
/// lights with units, and of emissive meshes, lights and environments of the user's with which an exposure of
/// 1 shows too much or too little. Files that state their surroundings are shown as they state. Nothing where
/// nothing is shown (SceneSettings::shows). Says both in scene.warnings. `stated`: the file's own
/// surroundings, before light was added.
Expected<void> settle_brightness(const settings::SceneSettings& settings, bool stated, StagedScene& staged);

}  // namespace tenebra::session
