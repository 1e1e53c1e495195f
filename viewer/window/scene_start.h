// What the window sets when a scene has come: its clock, its camera, its lights.
#pragma once

#include "window/view_options.h"

namespace tenebra::viewer {

/// `state` for `staged`, which was opened with `scene`. The first scene starts as `given` by the command
/// line, others go on as the scene before.
void start_scene(ViewState& state, std::shared_ptr<const session::StagedScene> staged, SceneOptions scene,
                 const ViewOptions& given, AnimationClock::Wall now);

}  // namespace tenebra::viewer
