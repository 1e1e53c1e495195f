// Surface samples on disk (cache_file.h), known by a key of what they follow from.
#pragma once

#include <filesystem>

#include <tenebra/expected.h>
#include "ao/cache/cache_file.h"
#include "ao/surface/self_occlusion.h"

namespace tenebra::ao {

/// Of the geometry, the reach (every bit of it) and the version of the method.
CacheKey sample_key(const ObjectShape& shape, double reach);

/// FOLDER/KEY.samples, the key in hexadecimal.
std::filesystem::path sample_path(const std::filesystem::path& folder, const CacheKey& key);

/// Together with what the file holds already, if it can be read. Whole or absent; of two processes that save
/// at the same time one may leave out what the other has just added. `count`: samples of the layout.
Expected<void> save_samples(const std::filesystem::path& folder, const CacheKey& key, SurfaceSamples samples,
                            std::size_t count);

/// A sentence if there is no such file or it is not as it was written. Memory is bounded by `count`.
Expected<SurfaceSamples> load_samples(const std::filesystem::path& folder, const CacheKey& key,
                                      std::size_t count);

}  // namespace tenebra::ao
