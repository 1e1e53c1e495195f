// The window itself: GLFW, its OpenGL context and Dear ImGui on it. The only place that uses GLFW.
#pragma once

#include "window/view_options.h"

namespace tenebra::viewer {

/// Opens the window and runs it until the user quits. Exit code, or one sentence of what is missing.
Expected<int> run_window(const ViewOptions& options);

}  // namespace tenebra::viewer
