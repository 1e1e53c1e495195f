// What the window shows as arguments of `tenebra render SCENE`, to be pasted into a shell.
#pragma once

#include <string>

#include "window/view_state.h"

namespace tenebra::viewer {

/// Camera, method and lights of the active slot at `time_s`, for a picture of `size`: the same bits. Quoted
/// where a POSIX shell would take a word apart.
std::string shell_arguments(const ViewState& state, double time_s, Size size);

}  // namespace tenebra::viewer
