// The picture of a scene's surroundings.
#pragma once

#include <filesystem>

#include <tenebra/expected.h>
#include "io/image.h"

namespace tenebra::session {

/// Three linear channels of a Radiance picture or, where the build has the library, an OpenEXR picture. What
/// is not finite or below 0 fails: it would be light.
Expected<io::ImageF> read_environment(const std::filesystem::path& path);

}  // namespace tenebra::session
