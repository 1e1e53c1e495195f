// The scenes that come with the program.
#pragma once

#include <filesystem>

#include <tenebra/expected.h>

namespace tenebra::viewer {

/// The bundled scene `name`, in ../share/tenebra/scenes beside the folder of the program: of an installation,
/// or of a build folder, where that is a link to the checkout's scenes.
Expected<std::filesystem::path> bundled_scene(const std::string& name);

}  // namespace tenebra::viewer
