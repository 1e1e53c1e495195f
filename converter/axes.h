// Axes that Assimp reads and does not follow.
#pragma once

struct aiScene;

namespace tenebra::converter {

/// Turns the root where the metadata of an FBX file say that another axis than Y is up and the root has not
/// been turned for it: Assimp 5.2 leaves that to us. False: they state the axes of a mirror, not followed.
bool turn_upright(const aiScene& scene);

}  // namespace tenebra::converter
