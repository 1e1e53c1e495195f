// Scene options as the text that gives them on the command line.
#pragma once

#include <string>

#include "options/scene_options.h"

namespace tenebra::viewer {

/// "--scene hall --no-cast glass ...": how the scene is read and dressed, without its file, moment, camera
/// and edits. Each option whose value is not the default, followed by a space.
std::string dressing_arguments(const SceneOptions& options);

/// The same for clip, camera and the size of pictures, as the user gave them.
std::string view_arguments(const SceneOptions& options);

}  // namespace tenebra::viewer
