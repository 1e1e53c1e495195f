// Hashes of what the whole renderer draws: these may depend on the graphics driver, so no test compares them.
#pragma once

#include "bench/hash/hash_lines.h"
#include "gl/context.h"

namespace tenebra::bench {

/// Ids, pictures and masks of the scene's frames with hard shadows, soft shadows and ambient occlusion; a
/// comment before them names the driver.
Expected<std::vector<std::string>> hash_pictures(const Scene& scene, const HashedScene& chosen,
                                                 gl::Context context, int scale);

}  // namespace tenebra::bench
