// Hashes that tell whether files and texts are the same.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <tenebra/expected.h>

namespace tenebra::io {

/// 128 bits of XXH3 in hexadecimal.
std::string text_hash(std::string_view text);
/// The hash of a regular file's bytes, however many. Fails as open_input_file().
Expected<std::string> file_hash(const std::filesystem::path& path);

}  // namespace tenebra::io
