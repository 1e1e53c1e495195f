// How a render writes its pictures: as PNG or OpenEXR files, or to a pipe.
#pragma once

#include <optional>
#include <string>

#include "io/exr/exr_file.h"
#include "options/output_pattern.h"
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

/// Adds -o and what belongs to it; read into `options`, which must live as long.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// Of these --aov alone, for callers that keep the pictures themselves.
void add_aov_option(CLI::App& command, render::AovChoice& aovs);

/// Fails if `settings` do not compute what `aovs` need.
Expected<void> check_aovs(const render::AovChoice& aovs, const render::RenderSettings& settings);

/// Sets what follows from other options. To be called once all are read.
void settle_picture_options(PictureOptions& options);

/// What single options cannot check.
Expected<void> check_picture_options(const PictureOptions& options);

/// "-o %04d.exr (half, zip, depth)", without folders, which may be named in several ways.
std::string pictures_text(const PictureOptions& options);

}  // namespace tenebra::viewer
