// A picture from a file of any kind that the program reads: as its file has it, and as linear light.
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "io/image.h"

namespace tenebra::viewer {

/// 8 bits as stored, or floats: one or three channels.
using LoadedPicture = std::variant<io::Image8, io::ImageF>;

/// By the end of the name: .exr (`layer` of it, or the colours where that is empty), .pfm, else PNG. Fails
/// with a sentence.
Expected<LoadedPicture> load_picture(const std::filesystem::path& path, const std::string& layer);

/// Three channels: PNG by the curve of sRGB and without its alpha, floats as they are, one channel thrice.
io::ImageF linear_colors(const LoadedPicture& picture);

}  // namespace tenebra::viewer
