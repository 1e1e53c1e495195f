// Scenes that another program, tenebra-assimp, reads for us by the library Assimp.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "formats/import_scene.h"

namespace tenebra::formats {

/// The program that converts, and what it may use. Of memory and processor time it limits itself.
struct Converter {
  std::filesystem::path program;                  ///< empty: there is none
  std::chrono::milliseconds least_time{120'000};  ///< by the clock, and 2 s for each MiB of the file
  std::size_t least_output = 64 << 20;            ///< bytes, and 32 for each of the file; at most 2 GiB
};

/// tenebra-assimp beside the running program, or beside the library that this is in, or where either is
/// installed.
Converter find_converter();

/// Has the converter write `path` as glTF and imports that by all rules of glTF; pictures are looked for
/// around `path`. However the converter fails, there is one sentence with the next step. Does not place.
Expected<Scene> import_converted(const std::filesystem::path& path, const ImportOptions& options,
                                 const Converter& converter);

/// import_gltf of the content of a file: `bytes` instead of what is in `path`.
Expected<Scene> import_gltf_bytes(const std::filesystem::path& path, const std::string& bytes,
                                  const ImportOptions& options);

}  // namespace tenebra::formats
