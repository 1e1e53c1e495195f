// Pictures of the contestants' irradiance, to be looked at side by side.
#pragma once

#include <filesystem>

#include "bench/soft/soft_contest.h"

namespace tenebra::bench {

/// VIEW_tenebra.png and VIEW_embree_RAYS_rays.png in `folder`: irradiance over white, as sRGB.
Expected<void> write_pictures(const Contest& contest, int width, int height,
                              const std::filesystem::path& folder);

}  // namespace tenebra::bench
