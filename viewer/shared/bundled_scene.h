// The scenes that come with the program.
#pragma once

#include <filesystem>

#include <tenebra/expected.h>

namespace tenebra::viewer {

/// The bundled scene `name`: of the installation that the program is in, else of the checkout it was built
/// from.
Expected<std::filesystem::path> bundled_scene(const std::string& name);

}  // namespace tenebra::viewer
