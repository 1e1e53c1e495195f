// How a render writes its pictures: as PNG or OpenEXR files, or to a pipe.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/exr/exr_file.h"
#include "options/settings_names.h"
#include "render/renderer.h"
#include "shell/command_line.h"

namespace tenebra::viewer {

/// Frames in standard output, one after another with nothing between: PNG files, or rows of red, green and
/// blue, a byte each.
enum class PipeFormat { png, rgb24 };

struct PictureOptions {
  std::optional<OutputPattern> files;  ///< .png or .exr; none: no files
  bool to_pipe = false;                ///< -o -
  std::optional<PipeFormat> pipe_format;
  render::AovChoice aovs;  ///< further layers of OpenEXR pictures
  std::optional<io::exr::Precision> precision;
  std::optional<io::exr::Compression> compression;

  bool are_exr() const { return files && files->is_exr(); }
};

/// -o: a name, - or none.
Expected<void> read_pictures(const std::string& text, PictureOptions& options);
/// "float,piz", of the words that are `known`; and back.
Expected<void> read_format(const std::string& text, const std::vector<std::string_view>& known,
                           PictureOptions& options);
std::vector<std::string> format_words(const PictureOptions& options);

/// Sets what follows from other options. To be called once all are read.
void settle_picture_options(PictureOptions& options);

/// What single options cannot check.
Expected<void> check_picture_options(const PictureOptions& options);

/// "-o %04d.exr (half, zip, depth)", without folders, which may be named in several ways.
std::string pictures_text(const PictureOptions& options);

}  // namespace tenebra::viewer
