// What `tenebra info --gl` says.
#pragma once

namespace tenebra::viewer {

/// Prints the devices and platforms that OpenGL can draw on without a window, and what `auto` takes.
int print_gl_survey(bool json);

}  // namespace tenebra::viewer
