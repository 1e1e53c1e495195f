// Fields on disk (cache_file.h), known by a key of what they were made from.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <span>

#include <tenebra/expected.h>
#include "ao/cache/cache_file.h"
#include "ao/field/displacement_field.h"

namespace tenebra::ao {

/// Of geometry, settings and the version of the method.
CacheKey field_key(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                   const FieldSettings& settings);

/// FOLDER/KEY.field, the key in hexadecimal.
std::filesystem::path field_path(const std::filesystem::path& folder, const CacheKey& key);

/// Whole or absent. Creates the folder if it is missing.
Expected<void> save_field(const std::filesystem::path& folder, const CacheKey& key,
                          const DisplacementField& field);

/// The field with this key and these settings; a sentence if the file is missing, damaged, cut short, of
/// another version or of another key. Memory is bounded by the settings, whatever the file says.
Expected<DisplacementField> load_field(const std::filesystem::path& folder, const CacheKey& key,
                                       const FieldSettings& settings);

}  // namespace tenebra::ao
