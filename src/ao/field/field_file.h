// Fields on disk: compressed without loss, known by a key of what they were made from, and trusted only when
// every byte is as it was written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>

#include <tenebra/expected.h>
#include "ao/field/displacement_field.h"

namespace tenebra::ao {

/// 128 bits of XXH3 over geometry, settings and the version of the method.
struct FieldKey {
  std::uint64_t low = 0;
  std::uint64_t high = 0;
  friend bool operator==(const FieldKey&, const FieldKey&) = default;
};
FieldKey field_key(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                   const FieldSettings& settings);

/// FOLDER/KEY.field, the key in hexadecimal.
std::filesystem::path field_path(const std::filesystem::path& folder, const FieldKey& key);

/// Whole or absent. Creates the folder if it is missing.
Expected<void> save_field(const std::filesystem::path& folder, const FieldKey& key,
                          const DisplacementField& field);

/// The field with this key and these settings; a sentence if the file is missing, damaged, cut short, of
/// another version or of another key. Memory is bounded by the settings, whatever the file says.
Expected<DisplacementField> load_field(const std::filesystem::path& folder, const FieldKey& key,
                                       const FieldSettings& settings);

}  // namespace tenebra::ao
